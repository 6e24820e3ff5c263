//! What the embedded lab's phrases hear in sentences that were not written for them: the table `claims.txt`.

use polemark::grading::{self, Catalogue};
use polemark::lab::{self, Points};
use polemark::reference::Reference;
use polemark::submission::{self, NoFiles};

struct Claim {
    criterion: String,
    sentence: String,
    /// What a careful teacher hears.
    claimed: bool,
    /// The program is known to hear it otherwise.
    known: bool,
}

fn claims() -> Vec<Claim> {
    let mut criterion = String::new();
    let mut claims: Vec<Claim> = Vec::new();
    for line in include_str!("claims.txt").lines() {
        match (line.split_at_checked(2), claims.last_mut()) {
            (Some((sign @ ("+ " | "- "), sentence)), _) => claims.push(Claim {
                criterion: criterion.clone(),
                sentence: sentence.to_owned(),
                claimed: sign == "+ ",
                known: false,
            }),
            (Some(("  ", "known")), Some(last)) => last.known = true,
            _ if line.starts_with('[') => criterion = line.trim_matches(['[', ']']).to_owned(),
            _ => assert!(line.is_empty() || line.starts_with('#'), "claims.txt: `{line}`"),
        }
    }
    claims
}

#[test]
fn the_phrases_hear_what_a_teacher_hears() {
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab is right");
    let reference = Reference::compute(&lab).expect("the embedded lab has a reference");
    let mut wrong = Vec::new();
    for Claim { criterion, sentence, claimed, known } in claims() {
        let asked = lab.questions.iter().flat_map(|question| &question.criteria).find(|c| c.id == criterion);
        let field = &asked.unwrap_or_else(|| panic!("claims.txt: no criterion `{criterion}`")).field;
        let file = format!("answers:\n  {field}: |\n    {sentence}\n");
        let submission = submission::read("claim", "claim.yaml", file.as_bytes(), &lab.sheet, &NoFiles);
        let scorecard = grading::grade(&lab, &reference, &Catalogue::default(), &submission, None);
        let item =
            scorecard.questions.iter().flat_map(|question| &question.items).find(|i| i.id == criterion);
        let heard = item.expect("every criterion is marked").earned > Points::ZERO;
        if (heard == claimed) == known {
            let teacher = if claimed { "+" } else { "-" };
            let but = if known { "is known to be misheard, and is not" } else { "is misheard" };
            wrong.push(format!("{criterion}: `{teacher} {sentence}` {but}"));
        }
    }
    assert!(wrong.is_empty(), "{} of the sentences\n{}", wrong.len(), wrong.join("\n"));
}
