use super::context::{self, Remark};
use super::number::ClaimedNumber;
use super::phrase::Said;
use super::sentence::{Sentence, sentences};
use super::values::{of, values};
use super::vocabulary::PHRASES;
use crate::source::Span;

/// More claims than these are not looked for: nobody says so much about one response.
const MOST: usize = 100;

/// In a sentence of more words than these nobody can tell what belongs to what.
const LONGEST_SENTENCE: usize = 200;

/// Something prose says about a response.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Bytes of the prose: the words that say it.
    pub span: Span,
    pub kind: ClaimKind,
    /// It is said not to be so: `not stable`, `does not oscillate`.
    pub denied: bool,
}

/// What is claimed, of a response and the system behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClaimKind {
    Stable,
    MarginallyStable,
    Unstable,
    /// Swings about some value.
    Oscillates,
    /// Goes to a final value: dies away, settles, comes to rest.
    DiesAway,
    GrowsWithoutBound,
    /// Goes on for ever.
    NeverEnds,
    /// Swings with constant amplitude.
    ConstantAmplitude,
    Value(Quantity, ClaimedNumber),
}

/// What a value is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Initial,
    Final,
    /// An extremum.
    Peak,
    PeriodS,
}

impl Claim {
    /// As a clause: `it is not stable`, `the final value is 0`.
    pub fn words(&self) -> String {
        let not = if self.denied { "not " } else { "" };
        match self.kind {
            ClaimKind::Stable => format!("it is {not}stable"),
            ClaimKind::MarginallyStable => format!("it is {not}marginally stable"),
            ClaimKind::Unstable => format!("it is {not}unstable"),
            ClaimKind::Oscillates if self.denied => "it does not oscillate".to_owned(),
            ClaimKind::Oscillates => "it oscillates".to_owned(),
            ClaimKind::DiesAway if self.denied => "it does not settle".to_owned(),
            ClaimKind::DiesAway => "it settles".to_owned(),
            ClaimKind::GrowsWithoutBound if self.denied => "it does not grow without bound".to_owned(),
            ClaimKind::GrowsWithoutBound => "it grows without bound".to_owned(),
            ClaimKind::NeverEnds if self.denied => "it does not go on for ever".to_owned(),
            ClaimKind::NeverEnds => "it goes on for ever".to_owned(),
            ClaimKind::ConstantAmplitude => format!("its amplitude is {not}constant"),
            ClaimKind::Value(of, number) => {
                let (name, unit) = match of {
                    Quantity::Initial => ("the initial value", ""),
                    Quantity::Final => ("the final value", ""),
                    Quantity::Peak => ("the peak", ""),
                    Quantity::PeriodS => ("the period", " s"),
                };
                format!("{name} is {not}{}{unit}", number.words())
            }
        }
    }
}

/// What `prose` claims about the response it describes, in text order.
///
/// Cautious: what is said of something else (`unlike at the bottom`), conditionally (`would`, `if`), as a question, of what was
/// expected once, or both ways, is left out, and so is every sentence that has a word of `elsewhere` (names of other
/// operating points). Time grows in proportion to the length of the text.
pub fn claims(prose: &str, elsewhere: &[&str]) -> Vec<Claim> {
    let mut found: Vec<Claim> = Vec::new();
    let read = sentences(prose);
    for (place, sentence) in read.iter().enumerate() {
        if found.len() >= MOST {
            break;
        }
        if sentence.len() > LONGEST_SENTENCE {
            continue;
        }
        let next = read.get(place + 1).and_then(|next| next.first());
        let asked = context::is_question(prose, sentence, next);
        if asked || sentence.iter().any(|token| elsewhere.contains(&token.text.as_str())) {
            continue;
        }
        found.extend(in_sentence(prose, sentence));
    }
    found.truncate(MOST);
    let kept = |claim: &&Claim| !found.iter().any(|other| opposed(claim, other));
    let kept: Vec<Claim> = found.iter().filter(kept).cloned().collect();
    kept
}

fn in_sentence(prose: &str, sentence: &Sentence) -> Vec<Claim> {
    struct Candidate {
        said: Said,
        kind: Option<ClaimKind>,
    }
    let mut all: Vec<Candidate> = Vec::new();
    for (kind, phrases) in PHRASES.iter() {
        for phrase in phrases {
            all.extend(phrase.said_in(sentence).into_iter().map(|said| Candidate { said, kind: *kind }));
        }
    }
    // The longer phrase decides: `marginally stable` is not `stable`.
    all.sort_by_key(|one| (one.said.first, usize::MAX - one.said.last));
    let mut reached = 0;
    all.retain(|one| {
        let covered = one.said.last < reached;
        reached = reached.max(one.said.last + 1);
        !covered
    });
    let mut claims: Vec<Claim> = all
        .iter()
        .filter_map(|one| Some((one, one.kind?)))
        .filter(|(one, kind)| context::speaks_of_it(sentence, &one.said, remark(*kind)))
        .map(|(one, kind)| Claim { span: one.said.span, kind, denied: one.said.denied })
        .collect();
    let values = values(prose, sentence);
    // `settles at 0` says where it settles.
    claims.retain(|claim| {
        let within = |value: &Claim| value.span.start <= claim.span.start && claim.span.end <= value.span.end;
        claim.kind != ClaimKind::DiesAway
            || !values.iter().any(|value| {
                of(value) == Some(Quantity::Final) && value.denied == claim.denied && within(value)
            })
    });
    claims.extend(values);
    claims.sort_by_key(|claim| (claim.span.start, claim.span.end));
    // `grows or decays`: neither is claimed.
    let affirmed = claims.iter().filter(|claim| !claim.denied).count();
    if affirmed > 1 && sentence.iter().any(|token| token.text == "or") {
        return Vec::new();
    }
    // `dies away for ever` says that it dies away.
    let settles = |claim: &Claim| claim.kind == ClaimKind::DiesAway || of(claim) == Some(Quantity::Final);
    if claims.iter().any(|claim| settles(claim) && !claim.denied) {
        claims.retain(|claim| claim.kind != ClaimKind::NeverEnds);
    }
    claims
}

fn remark(kind: ClaimKind) -> Remark {
    match kind {
        ClaimKind::Stable | ClaimKind::MarginallyStable | ClaimKind::Unstable => Remark::System,
        ClaimKind::Value(..) => Remark::Value,
        _ => Remark::Motion,
    }
}

/// Whether two claims cannot both be meant of one response.
fn opposed(a: &Claim, b: &Claim) -> bool {
    use ClaimKind::*;
    if let (Value(of, one), Value(of_other, other)) = (a.kind, b.kind) {
        // One response has many peaks.
        let apart = !one.near(other.value, 0.0) && !other.near(one.value, 0.0);
        return of == of_other && of != Quantity::Peak && (apart != (a.denied != b.denied));
    }
    if a.kind == b.kind {
        return a.denied != b.denied;
    }
    if a.denied || b.denied {
        return false;
    }
    let group = |kind| match kind {
        Stable | MarginallyStable | Unstable => 1,
        DiesAway | GrowsWithoutBound | NeverEnds | ConstantAmplitude | Value(Quantity::Final, _) => 2,
        _ => 0,
    };
    let settles = |kind| matches!(kind, DiesAway | Value(Quantity::Final, _));
    let ends = settles(a.kind) != settles(b.kind);
    match (group(a.kind), group(b.kind)) {
        (1, 1) => true,
        (2, 2) => ends,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, &str)]) {
        let wrong: Vec<String> = rows
            .iter()
            .filter_map(|(text, want)| {
                let found: Vec<String> = claims(text, &["upright"]).iter().map(Claim::words).collect();
                let found = found.join("; ");
                (found != *want).then(|| format!("{text:?}\n  wanted {want:?}\n  found  {found:?}"))
            })
            .collect();
        assert!(wrong.is_empty(), "{} of {}\n{}", wrong.len(), rows.len(), wrong.join("\n"));
    }

    #[test]
    fn stability_is_claimed_and_denied() {
        check(&[
            ("The system is stable.", "it is stable"),
            ("Stable.", "it is stable"),
            ("It is asymptotically stable", "it is stable"),
            ("The system is unstable, as one pole is positive.", "it is unstable"),
            ("It is not stable.", "it is not stable"),
            ("It isn't stable at all!", "it is not stable"),
            ("It is never unstable.", "it is not unstable"),
            ("It is stable, not unstable.", "it is stable; it is not unstable"),
            ("It is marginally stable.", "it is marginally stable"),
            (
                "Because of the eigenvalue at zero I would call it marginally stable.",
                "it is marginally stable",
            ),
            ("All three poles are in the left half-plane.", "it is stable"),
            ("One pole in the right half plane makes the system unstable.", "it is unstable; it is unstable"),
            ("There are no poles in the right half-plane.", "it is not unstable"),
            ("The plot shows an instability.", "it is unstable"),
            ("The system seems to be stable.", "it is stable"),
            ("As expected, it is unstable.", "it is unstable"),
            ("It is unstable, as we had expected.", "it is unstable"),
            ("We expected it to be stable, but it is unstable.", "it is unstable"),
            ("It is an unstable equilibrium.", "it is unstable"),
            ("It grows exponentially; the two stable poles die away.", "it grows without bound"),
            ("The stable mode is soon gone.", ""),
        ]);
    }

    #[test]
    fn motion_is_claimed_and_denied() {
        check(&[
            ("It oscillates.", "it oscillates"),
            ("The angle does not oscillate.", "it does not oscillate"),
            ("There are no oscillations.", "it does not oscillate"),
            ("It moves back and forth.", "it oscillates"),
            ("The oscillation dies away.", "it oscillates; it settles"),
            ("It swings about zero and settles.", "it oscillates; it settles"),
            ("The response is damped.", "it settles"),
            ("It comes to rest.", "it settles"),
            ("It never settles.", "it does not settle"),
            ("It doesn't come to rest.", "it does not settle"),
            ("It grows without bound.", "it grows without bound"),
            ("The angle goes to infinity.", "it grows without bound"),
            ("The angle runs away.", "it grows without bound"),
            ("The angle tends to minus infinity.", "it grows without bound"),
            ("The angle goes to negative infinity.", "it grows without bound"),
            ("As t goes to plus infinity the oscillation vanishes.", "it oscillates"),
            ("It does not run away.", "it does not grow without bound"),
            ("It diverges exponentially.", "it grows without bound"),
            ("The output is unbounded.", "it grows without bound"),
            ("It does not grow without bound.", "it does not grow without bound"),
            ("It does not blow up.", "it does not grow without bound"),
            ("It goes on for ever.", "it goes on for ever"),
            ("The pendulum continues to rotate forever.", "it goes on for ever"),
            ("It swings indefinitely.", "it goes on for ever"),
            ("It does not oscillate for ever.", "it does not go on for ever"),
            ("The pendulum starts to rotate about its axis indefinitely.", "it goes on for ever"),
            ("In our simulation it gets larger with time.", "it grows without bound"),
            ("Each swing is a little larger than the one before.", "it grows without bound"),
            ("Each swing is smaller than the previous one.", "it settles"),
            ("It decays for ever, more and more slowly.", "it settles"),
            ("It swings with constant amplitude.", "its amplitude is constant"),
            ("It is a sustained oscillation.", "its amplitude is constant"),
            ("The amplitude does not remain constant.", "its amplitude is not constant"),
            ("It is an oscillation with decreasing amplitude.", "it oscillates; it settles"),
        ]);
    }

    #[test]
    fn values_are_claimed_with_their_name() {
        check(&[
            ("The initial value is 0.", "the initial value is 0"),
            ("The initial value of the response is 0 rad.", "the initial value is 0"),
            ("Initial value: 0", "the initial value is 0"),
            ("It starts at 0.", "the initial value is 0"),
            ("The curve starts from zero.", "the initial value is 0"),
            ("The angle starts at $0$.", "the initial value is 0"),
            ("The final value is not 0.", "the final value is not 0"),
            ("It has a final value of 2.5.", "the final value is 2.5"),
            ("It settles at 0.", "the final value is 0"),
            ("It settles at about −0.3 rad.", "the final value is about -0.3"),
            ("It converges to 2,5 V.", "the final value is 2.5"),
            ("The angle returns to zero.", "the final value is 0"),
            ("The angle does not return to zero.", "the final value is not 0"),
            ("It goes back to 0 rad.", "the final value is 0"),
            ("Initial and final value are both zero.", "the initial value is 0; the final value is 0"),
            ("It begins and ends at zero.", "the initial value is 0; the final value is 0"),
            ("It has a peak of -0.79 rad.", "the peak is -0.79"),
            ("The maximum value is 0.82.", "the peak is 0.82"),
            ("It oscillates with a period of about 1.12 s.", "it oscillates; the period is about 1.12 s"),
            ("The period is 1.1 seconds.", "the period is 1.1 s"),
        ]);
    }

    #[test]
    fn what_is_not_said_of_this_response_is_left() {
        check(&[
            // said of something else
            ("Unlike at the stable bottom, it falls.", ""),
            ("In the upright position it is unstable.", ""),
            ("The other system is stable.", ""),
            ("The real pendulum comes to rest.", ""),
            ("With a controller it is stable.", ""),
            ("In question 2 it was unstable.", ""),
            ("A system is stable when all poles are negative.", ""),
            ("Both oscillate about a stable equilibrium.", "it oscillates"),
            ("The transient term decays.", ""),
            ("The decaying exponential is soon gone.", ""),
            ("The settling time is 200 s.", ""),
            ("It settles into a limit cycle.", ""),
            // what might be
            ("It would oscillate.", ""),
            ("Without friction it would go on for ever.", ""),
            ("It decays if it is stable and it grows without bound if it is unstable.", ""),
            ("It could be unstable.", ""),
            ("Perhaps it settles.", ""),
            ("A force is needed to make it stable.", ""),
            ("We need to keep it stable.", ""),
            // a question
            ("Is it stable?", ""),
            ("Stable or unstable?", ""),
            // once expected
            ("I expected it to be stable.", ""),
            ("We thought that it oscillates.", ""),
            ("Our prediction was that it dies out.", ""),
            // both ways
            ("It is stable or unstable.", ""),
            ("It grows exponentially or it decays to zero.", ""),
            ("It is stable. It is unstable.", ""),
            ("It settles at 0. It grows without bound.", ""),
            // how much, and for how long
            ("It is almost stable.", ""),
            ("It is less stable than that.", ""),
            ("It is as stable as the other.", ""),
            ("At first it grows exponentially.", ""),
            ("It has nearly constant amplitude.", ""),
            // not a value
            ("It starts at t = 0.", ""),
            ("It starts at 0 s.", ""),
            ("It settles at 200 s.", "it settles"),
            ("It settles to 2 % of the peak.", "it settles"),
            ("It goes to 0.8 rad and comes back.", ""),
            ("The amplitude decays to zero.", "it settles"),
            ("The peak time is 0.84 s.", ""),
            ("The final value is 0 or 1.", ""),
            ("The maximum is 45 degrees.", ""),
            ("The period is 1.12 rad.", ""),
            // nothing at all
            ("", ""),
            ("The unstable\u{0}", "it is unstable"),
            ("Restable, astable, a stablemate.", ""),
        ]);
    }

    #[test]
    fn claims_stand_on_their_words() {
        let text = "Über $x$: it isn’t stable; the initial value is 0.";
        let found: Vec<&str> =
            claims(text, &[]).iter().map(|claim| &text[claim.span.start..claim.span.end]).collect();
        assert_eq!(found, ["stable", "initial value is 0"]);
    }

    #[test]
    fn a_wall_of_claims_is_read_in_good_time() {
        let wall = "it is stable and settles at 0, never unstable ".repeat(5_000);
        assert!(claims(&wall, &[]).len() <= MOST);
        let wall = "It is stable. ".repeat(5_000);
        assert_eq!(claims(&wall, &[]).len(), MOST);
    }

    proptest::proptest! {
        #[test]
        fn any_text_can_be_read(text in "\\PC{0,60}|(is |not |stable|settles |at |0|-|\\$|or |final value |\\.|, ){0,12}") {
            for claim in claims(&text, &[]) {
                proptest::prop_assert!(text.get(claim.span.start..claim.span.end).is_some());
            }
        }
    }
}
