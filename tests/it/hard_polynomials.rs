//! Roots, multiplicities and verdicts of hard polynomials, against 60 digits found by another route.

use crate::hard_table::{Entry, multiplied_out, table};
use polemark::algebra::{Polynomial, Rational};
use polemark::lti::{Pole, Stability, TransferFunction, right_half_plane_roots, roots, stability};

fn exactly(value: f64) -> Rational {
    Rational::try_from(value).unwrap()
}

fn square(x: Rational) -> Rational {
    &x * &x
}

/// Whether the disc holds the root, decided in exact arithmetic.
fn encloses(pole: &Pole, re: &Rational, im: &Rational) -> bool {
    let distance = square(exactly(pole.re) - re) + square(exactly(pole.im) - im);
    distance <= square(exactly(pole.error_bound))
}

/// Everything the table says of `entry`; empty when it is met.
fn faults(entry: &Entry) -> Vec<String> {
    let mut faults = Vec::new();
    let mut demand = |holds: bool, what: String| {
        if !holds {
            faults.push(format!("{}: {what}", entry.name));
        }
    };
    let num = entry.num.clone().unwrap_or_else(Polynomial::one);
    let (g, shared) = TransferFunction::new(num, entry.p.clone()).unwrap().cancelled();
    demand(shared.degree() == entry.cancels, format!("a factor of degree {} cancels", shared.degree()));
    let p = g.den;
    let (verdict, right) = (stability(&p), right_half_plane_roots(&p));
    demand(verdict.as_str() == entry.stability, format!("{verdict:?}"));
    demand(right == entry.right, format!("{right} on the right"));
    let found = match (roots(&p), &entry.refused) {
        (Ok(found), None) => found,
        (Err(error), Some(expected)) => {
            demand(format!("{error:?}") == *expected, format!("{error:?}"));
            return faults;
        }
        (other, _) => {
            demand(false, format!("{other:?}"));
            return faults;
        }
    };
    demand(stability_of(&found) == verdict, "the poles say otherwise".to_string());
    let of_degree: usize = found.iter().map(|pole| pole.multiplicity).sum();
    demand(of_degree == p.degree(), format!("{of_degree} roots"));
    // Each true root has a disc of its own.
    let mut rest = found;
    let zero = Rational::ZERO;
    for (multiplicity, re, im) in &entry.roots {
        let lower = (*im != zero).then(|| -im.clone());
        for im in std::iter::once(im.clone()).chain(lower) {
            let close = |pole: &Pole| {
                let part = |found: f64, truth: &Rational| {
                    square(exactly(found) - truth) <= square(truth * exactly(3e-16))
                };
                pole.multiplicity == *multiplicity
                    && encloses(pole, re, &im)
                    && part(pole.re, re)
                    && part(pole.im, &im)
                    && pole.error_bound <= 2.3e-16 * pole.re.hypot(pole.im)
            };
            // Of those that hold it the narrowest, since a wider one may be all that holds another.
            let holding = (0..rest.len()).filter(|&at| close(&rest[at]));
            match holding.min_by(|&a, &b| rest[a].error_bound.total_cmp(&rest[b].error_bound)) {
                Some(at) => drop(rest.remove(at)),
                None => demand(
                    false,
                    format!("nothing encloses {} + {}j", re.to_f64().value(), im.to_f64().value()),
                ),
            }
        }
    }
    demand(rest.is_empty(), format!("left over: {rest:?}"));
    faults
}

fn stability_of(poles: &[Pole]) -> Stability {
    if poles.iter().any(|pole| pole.re > 0.0 || pole.re == 0.0 && pole.multiplicity > 1) {
        Stability::Unstable
    } else if poles.iter().any(|pole| pole.re == 0.0) {
        Stability::MarginallyStable
    } else {
        Stability::AsymptoticallyStable
    }
}

#[test]
fn every_enclosure_holds_its_root_and_every_verdict_is_right() {
    let entries = table();
    assert!(entries.len() >= 140, "{} polynomials", entries.len());
    let faults: Vec<String> = entries.iter().flat_map(faults).collect();
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Whatever a lab file can hold is decided, and its roots are found or refused; the limit on work is in the library.
#[test]
fn the_worst_that_can_be_typed_ends() {
    let digits = |seed: usize| {
        let digit = |k: usize| char::from(b'0' + ((seed + 1) * (k + 3) * (k + seed * seed) % 97 % 10) as u8);
        format!("1{}", (0..399).map(digit).collect::<String>())
    };
    let from =
        |term: &dyn Fn(usize) -> String| multiplied_out(&(0..=60).map(term).collect::<Vec<_>>().join(" "));
    let of_400_digits = from(&digits);
    let of_all_sizes = from(&|k| format!("{}e{}", k % 7 + 1, (k * k * 37 % 801) as i64 - 400));
    let thirty = multiplied_out("(1 2 3 4 5 6 7 8 9 1 2 3 4 5 6)^2 (1 1)^2");
    let squared = &(&thirty * &thirty) + &multiplied_out("1e-400");
    let too_close = from(&|k| match k {
        0 => "1".to_string(),
        58 => "-2e400".to_string(),
        59 => "4e200".to_string(),
        60 => "-2".to_string(),
        _ => "0".to_string(),
    });
    for (what, p) in [
        ("coefficients of 400 digits", of_400_digits),
        ("coefficients 1e-400 to 1e400", of_all_sizes),
        ("thirty pairs 1e-200 apart", squared),
        ("a pair that agrees in 6000 digits", too_close),
    ] {
        let verdict = stability(&p);
        let found = roots(&p);
        if let Ok(found) = found {
            assert_eq!(stability_of(&found), verdict, "{what}");
        }
    }
}
