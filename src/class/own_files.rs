use std::path::{Path, PathBuf};

/// What polemark writes into an output folder, beside reports.
const OWN: [&str; 6] =
    ["index.html", "gradebook.csv", "results.jsonl", "run.json", "compare.csv", "compare.html"];

/// Whether `path` is where polemark writes a file of its own in the output folder `out`, however both are spelled.
pub fn is_own_file(out: &Path, path: &Path) -> bool {
    let (Some(name), Some(folder)) = (path.file_name().and_then(|name| name.to_str()), folder_of(path))
    else {
        return false;
    };
    let Ok(out) = out.canonicalize() else { return false };
    let is_report = || {
        folder.parent() == Some(&out)
            && (folder.ends_with("reports") || folder.ends_with("instructor"))
            && name.ends_with(".html")
    };
    (folder == out && OWN.contains(&name)) || is_report()
}

/// A file where polemark is about to write its own, in a folder it has not written into before.
pub fn foreign_file(out: &Path) -> Option<PathBuf> {
    if out.join(".polemark").exists() || out.join("run.json").exists() {
        return None;
    }
    OWN.iter().map(|name| out.join(name)).find(|path| path.exists())
}

fn folder_of(path: &Path) -> Option<PathBuf> {
    let folder = path.parent()?;
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    folder.canonicalize().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_files_are_told_from_others() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        std::fs::create_dir_all(out.join("reports")).unwrap();
        for (path, own) in [
            ("out/index.html", true),
            ("out/../out/./gradebook.csv", true),
            ("out/reports/EE-001.html", true),
            ("out/reports/EE-001.yaml", false),
            ("out/marks.yaml", false),
            ("gradebook.csv", false),
            ("elsewhere/gradebook.csv", false),
        ] {
            assert_eq!(is_own_file(&out, &folder.path().join(path)), own, "{path}");
        }
        assert_eq!(foreign_file(&out), None);
        std::fs::write(out.join("gradebook.csv"), "").unwrap();
        assert_eq!(foreign_file(&out), Some(out.join("gradebook.csv")));
        std::fs::create_dir(out.join(".polemark")).unwrap();
        assert_eq!(foreign_file(&out), None);
    }
}
