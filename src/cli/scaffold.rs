//! The folder of a new lab.

use super::outcome::Failure;
use crate::lab::{LabDefinition, lab_schema};
use crate::source::{SourceText, sanitize};
use std::io::Write;
use std::path::Path;

const LAB: &str = include_str!("../../templates/new-lab/lab.yaml");
const README: &str = include_str!("../../templates/new-lab/README.md");

/// Makes `folder` with a small working lab in it, named after the folder where that is an id; says what was written.
///
/// Nothing is written where one of the files is there already.
pub fn scaffold(folder: &Path) -> Result<String, Failure> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let lab = lab_text(&name)?;
    let answers = lab.answer_template();
    let files = [
        ("lab.yaml", lab.text.text),
        ("README.md", README.to_owned()),
        ("answers.yaml", answers),
        ("lab.schema.json", serde_json::to_string_pretty(&lab_schema())? + "\n"),
    ];
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |error| Failure::Write { path, error }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    for (name, _) in &files {
        let path = folder.join(name);
        if path.exists() {
            return Err(failed(&path)(std::io::ErrorKind::AlreadyExists.into()));
        }
    }
    for (name, text) in &files {
        let path = folder.join(name);
        std::fs::File::create_new(&path)
            .and_then(|mut file| file.write_all(text.as_bytes()))
            .map_err(failed(&path))?;
    }
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    let shown = sanitize(&folder.to_string_lossy());
    Ok(format!("{shown}: {}\nNext: polemark verify {shown}\n", names.join(", ")))
}

/// The example under the name of its folder, or under its own where that cannot be an id.
fn lab_text(name: &str) -> Result<LabDefinition, Failure> {
    let parse = |text: String| LabDefinition::parse(SourceText::new("lab.yaml", text));
    let own = parse(LAB.replacen("lab: my-lab", &format!("lab: {name}"), 1));
    match own {
        Ok(lab) if lab.id == name => Ok(lab),
        _ => parse(LAB.to_owned()).map_err(|errors| Failure::Load(errors.into())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lab_is_named_after_its_folder_where_it_can_be() {
        for (folder, id) in [
            ("pendulum", "pendulum"),
            ("rlc-2", "rlc-2"),
            ("2nd lab", "my-lab"),
            ("", "my-lab"),
            ("a: b", "my-lab"),
        ] {
            assert_eq!(lab_text(folder).unwrap().id, id, "{folder}");
        }
    }
}
