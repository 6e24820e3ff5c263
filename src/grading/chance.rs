use super::likeness::{Row, Typed};
use std::f64::consts::LN_10;

/// The range a wrong coefficient may be anywhere in: a factor of ten to either side, and both signs; logarithmic.
const RANGE: f64 = 4.0 * LN_10;

/// Some of a function's coefficients, a bit for each.
pub(super) type Places = u64;

/// Every coefficient.
pub(super) fn all_of(typed: &Typed) -> Places {
    1u64.checked_shl(typed.values.len() as u32).map_or(Places::MAX, |next| next - 1)
}

/// How many of so many functions are expected to agree with arbitrary numbers at `places`.
///
/// Where these are all there are, one of them sets the common factor and says nothing.
pub(super) fn by_chance(functions: usize, typed: &Typed, places: Places) -> f64 {
    let within = |place: &usize| places & (1 << place) != 0;
    let share = |place: usize| (2.0 * typed.relative_width(place) / RANGE).min(1.0);
    let mut shares: Vec<f64> = (0..typed.values.len()).filter(within).map(share).collect();
    if places == all_of(typed) {
        shares.sort_by(f64::total_cmp);
        shares.pop();
    }
    functions as f64 * shares.iter().product::<f64>()
}

/// The coefficients that need another explanation than one of `simpler`: as few as can be, in every way there is.
///
/// What agrees with a simpler function in all but these is evidence for it, and not for anything else.
pub(super) fn in_question<'a>(simpler: impl Iterator<Item = &'a Row>, typed: &Typed) -> Vec<Places> {
    let all = all_of(typed);
    // One coefficient alone agrees with anything.
    let (mut fewest, mut found) = (typed.values.len().saturating_sub(1), vec![all]);
    for row in simpler.filter(|row| row.form == typed.form) {
        for pivot in 0..typed.values.len() {
            let rest = all & !agreeing(typed, row, pivot);
            let count = rest.count_ones() as usize;
            if count < fewest {
                fewest = count;
                found.clear();
            }
            if count == fewest && !found.contains(&rest) {
                found.push(rest);
            }
        }
    }
    found
}

/// The coefficients that agree with the row when the one at `pivot` does.
fn agreeing(typed: &Typed, row: &Row, pivot: usize) -> Places {
    let others = |place: usize| !((1 << place) | (1 << pivot));
    let agrees = |place: &usize| typed.factors(&row.values, others(*place)).is_some();
    (0..typed.values.len()).filter(agrees).fold(0, |bits, place| bits | 1 << place)
}

#[cfg(test)]
mod tests {
    use super::super::digits::Written;
    use super::super::likeness::tests::function;
    use super::*;

    fn typed(text: &str) -> Typed {
        Typed::new(&function(text), &Written::default()).unwrap()
    }

    #[test]
    fn only_what_nothing_simpler_explains_is_in_question() {
        let simpler =
            ["1.000/ 2.000 3.000 4.000", "1.000/ 2.000 5.000 4.000"].map(|f| Row::of(&function(f)).unwrap());
        for (text, places) in [
            ("1.000/ 2.000 7.001 4.000", &[0b0100][..]),
            ("2.002/ 4.004 7.001 8.008", &[0b0100]),
            ("1.001/ 2.002 3.003 9.001", &[0b1000]),
            // Two agree with the first, in one way or in another.
            ("1.001/ 2.002 6.001 8.001", &[0b1100, 0b0011]),
            ("1.001/ 2.002 8.888", &[0b111]),
        ] {
            assert_eq!(in_question(simpler.iter(), &typed(text)), places, "{text}");
        }
    }

    #[test]
    fn chance_shrinks_with_every_digit() {
        let four = typed("1.001/ 2.002 3.003");
        let two = typed("1.1/ 2.2 3.3");
        let share = 2.0 * 5e-4 / RANGE;
        assert!((by_chance(100, &four, 0b010) - 100.0 * share).abs() < 1e-12);
        assert!((by_chance(100, &four, 0b110) - 100.0 * share * share).abs() < 1e-12);
        assert!((by_chance(100, &four, 0b111) - 100.0 * share * share).abs() < 1e-12);
        assert!(by_chance(100, &two, 0b110) > 50.0 * by_chance(100, &four, 0b110));
    }
}
