//! Every point that the sample class did not earn stands in a ledger, once.

use polemark::grading::{self, Catalogue, Cause};
use polemark::lab::{self, Points};
use polemark::reference::Reference;
use polemark::submission::{self, Folder};
use std::fs;
use std::path::PathBuf;

#[test]
fn the_ledgers_of_the_sample_class_add_up() {
    let lab = lab::load(lab::DEFAULT).unwrap();
    let reference = Reference::compute(&lab).unwrap();
    let catalogue = Catalogue::new(&lab, &reference);
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("submissions");
    let (mut files, mut spared) = (0, 0);
    for entry in fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "yaml") {
            continue;
        }
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let bytes = fs::read(&path).unwrap();
        let submission = submission::read(&name, &name, &bytes, &lab.sheet, &Folder(folder.clone()));
        let card = grading::grade(&lab, &reference, &catalogue, &submission, None);
        let lost: Points = card.ledger.lost.iter().map(|loss| loss.points).sum();
        assert_eq!(lost + card.total.earned, card.total.possible, "{name}: {:#?}", card.ledger);
        let charged = |root: &str| card.ledger.lost.iter().any(|loss| loss.item == root);
        for loss in &card.ledger.lost {
            assert!(loss.points > Points::ZERO, "{name}: {loss:?}");
            if let Cause::Part { root } | Cause::Refused { root, .. } = &loss.cause {
                assert!(charged(root), "{name}: {loss:?}");
            }
        }
        for one in &card.ledger.spared {
            assert!(one.points > Points::ZERO && charged(&one.root), "{name}: {one:?}");
        }
        files += 1;
        spared += card.ledger.spared.len();
    }
    assert!(files > 20 && spared > 10, "{files} files, {spared} points spared");
}
