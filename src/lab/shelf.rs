macro_rules! shelf {
    ($($id:literal),* $(,)?) => {
        &[$(($id, include_str!(concat!("../../labs/", $id, "/lab.yaml")))),*]
    };
}

/// Labs inside the program: (id, text of the lab file), in the order in which they are listed.
pub(super) const SHELF: &[(&str, &str)] = shelf![
    "ee361-lab3",
    "inverted-pendulum",
    "cruise-control",
    "dc-motor",
    "ball-and-beam",
    "magnetic-levitation",
    "coupled-tanks",
    "aircraft-pitch",
    "suspension",
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::LabDefinition;
    use crate::source::SourceText;
    use std::collections::BTreeSet;

    #[test]
    fn every_folder_is_on_the_shelf_under_its_own_id() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("labs");
        let folders = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let folders: BTreeSet<String> = folders.map(|name| name.into_string().unwrap()).collect();
        let shelved: BTreeSet<String> = SHELF.iter().map(|(id, _)| (*id).to_owned()).collect();
        assert_eq!(shelved, folders);
        for (id, text) in SHELF {
            let lab = LabDefinition::parse(SourceText::new(*id, *text))
                .unwrap_or_else(|e| panic!("{}", e.render(false)));
            assert_eq!(lab.id, *id);
        }
    }
}
