use super::{Change, Comparison};
use crate::class::gradebook::disarmed;
use crate::lab::Points;

/// `compare.csv`: a row a difference.
pub fn comparison_csv(comparison: &Comparison) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["student_id", "student_name", "item", "old", "new", "change", "cause"])?;
    for row in comparison_rows(comparison) {
        writer.write_record(&row)?;
    }
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}

/// The cells of each row; text that a spreadsheet would run is disarmed.
pub fn comparison_rows(comparison: &Comparison) -> impl Iterator<Item = [String; 7]> + '_ {
    comparison.changes.iter().map(|change| {
        let Change { student, name, item, old, new, cause } = change;
        let shown = |points: &Option<Points>| points.map_or_else(String::new, |points| points.to_string());
        let by = old.zip(*new).map(|(old, new)| new - old);
        [disarmed(student), disarmed(name), disarmed(item), shown(old), shown(new), shown(&by), cause.clone()]
    })
}
