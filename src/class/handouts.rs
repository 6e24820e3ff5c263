use super::gradebook::disarmed;
use super::intake::UniqueNames;
use super::{Roster, RosterStudent};
use crate::lab::{LabDefinition, LabErrors, StudentEdition, Variant};
use crate::report::{HandoutKit, HandoutStudent, ReportError};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Handouts {
    pub sheets: usize,
    /// Different ones among them; 0 when everyone has the same values.
    pub variants: usize,
    /// Answer files that were there and hold something else.
    pub left_alone: usize,
}

#[derive(Debug, thiserror::Error)]
pub enum HandoutError {
    #[error(transparent)]
    Lab(#[from] LabErrors),
    #[error("`{}` cannot be written: {error}", path.display())]
    Write { path: PathBuf, error: io::Error },
    #[error(transparent)]
    Report(#[from] ReportError),
}

/// Writes the sheet, the answer file and the student edition of the lab for each student on the roster into a folder of their own
/// below `out`, and `variants.csv` with everyone's values; one sheet for all when the lab has the same values for everyone.
///
/// The same lab and roster give the same bytes.
pub fn write_handouts(
    lab: &LabDefinition,
    roster: Option<&Roster>,
    out: &Path,
) -> Result<Handouts, HandoutError> {
    let kit = HandoutKit::new()?;
    let edition = StudentEdition::of(lab);
    let edition = (edition.file_name(), edition.to_yaml());
    let (Some(rule), Some(roster)) = (&lab.variants, roster) else {
        let kept = write(out, &kit.sheet(lab, None), &lab.answer_template(), &edition)?;
        return Ok(Handouts { sheets: 1, variants: 0, left_alone: usize::from(kept) });
    };
    let mut names = UniqueNames::default();
    let students: Vec<(&RosterStudent, String, Variant)> = roster
        .students
        .iter()
        .filter_map(|student| Some((student, names.claim(&student.id), rule.of(&student.id)?)))
        .collect();
    let left = students.par_iter().map(|(student, folder, variant)| {
        let own = lab.with_variant(variant)?;
        let whose = HandoutStudent { id: &student.id, name: &student.name };
        let template = own.answer_template_for(&student.id, &student.name);
        write(&out.join(folder), &kit.sheet(&own, Some(whose)), &template, &edition)
    });
    let left: Vec<bool> = left.collect::<Result<_, HandoutError>>()?;
    write_list(lab, &students, &out.join("variants.csv"))?;
    Ok(Handouts {
        sheets: students.len(),
        variants: students.iter().map(|(_, _, variant)| variant).collect::<BTreeSet<_>>().len(),
        left_alone: left.into_iter().filter(|left| *left).count(),
    })
}

/// Whether an answer file with something else in it was there, and was left alone.
fn write(
    folder: &Path,
    sheet: &str,
    template: &str,
    (name, edition): &(String, String),
) -> Result<bool, HandoutError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |error| HandoutError::Write { path, error }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    let (page, answers) = (folder.join("handout.html"), folder.join("answers.yaml"));
    std::fs::write(&page, sheet).map_err(failed(&page))?;
    let for_check = folder.join(name);
    std::fs::write(&for_check, edition).map_err(failed(&for_check))?;
    // Somebody's answers may already be in it.
    match std::fs::File::create_new(&answers) {
        Ok(mut file) => io::Write::write_all(&mut file, template.as_bytes()).map_err(failed(&answers))?,
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            return Ok(std::fs::read(&answers).map_err(failed(&answers))? != template.as_bytes());
        }
        Err(error) => return Err(failed(&answers)(error)),
    }
    Ok(false)
}

fn write_list(
    lab: &LabDefinition,
    students: &[(&RosterStudent, String, Variant)],
    path: &Path,
) -> Result<(), HandoutError> {
    let Some(rule) = &lab.variants else { return Ok(()) };
    let failed =
        |error: csv::Error| HandoutError::Write { path: path.to_path_buf(), error: io::Error::other(error) };
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header = vec!["student_id", "student_name", "folder"];
    header.extend(rule.parameters.iter().map(|one| one.name.as_str()));
    writer.write_record(&header).map_err(failed)?;
    for (student, folder, variant) in students {
        let mut row = vec![disarmed(&student.id), disarmed(&student.name), disarmed(folder)];
        row.extend(rule.values(variant).into_iter().map(|(_, value)| value.to_owned()));
        writer.write_record(&row).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(|error| HandoutError::Write {
        path: path.to_path_buf(),
        error: io::Error::other(error.to_string()),
    })?;
    std::fs::write(path, bytes).map_err(|error| HandoutError::Write { path: path.to_path_buf(), error })
}
