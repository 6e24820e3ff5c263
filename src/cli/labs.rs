use super::outcome::{Failure, write_output};
use crate::lab::{self, LabDefinition, Points};
use std::process::ExitCode;

/// List the labs inside the program.
#[derive(clap::Args)]
#[command(
    after_long_help = "Examples:\n  polemark labs\n  polemark labs --format json\n\nAny verb takes an id of this list, or the path of a lab file."
)]
pub struct Arguments {
    /// `text` for people, `json` for other programs.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    Text,
    Json,
}

/// A lab in the list.
#[derive(serde::Serialize)]
struct Row {
    id: String,
    title: String,
    source: String,
    /// `cart.hanging`, and the ids of simulations.
    systems: Vec<String>,
    questions: usize,
    points: f64,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let labs =
        lab::embedded().iter().map(|(id, _)| lab::load(id).map(|lab| row(&lab)).map_err(Failure::Load));
    let rows = labs.collect::<Result<Vec<Row>, Failure>>()?;
    let text = match arguments.format {
        Format::Json => serde_json::to_string_pretty(&rows)? + "\n",
        Format::Text => table(&rows),
    };
    write_output(None, &text)?;
    Ok(ExitCode::SUCCESS)
}

fn row(lab: &LabDefinition) -> Row {
    let points = lab.models.iter().flat_map(|model| {
        model.operating_points.iter().map(move |point| format!("{}.{}", model.id, point.id))
    });
    let simulations = lab.simulations.iter().map(|simulation| simulation.id.clone());
    let worth: Points = lab.questions.iter().map(|question| question.points).sum();
    Row {
        id: lab.id.clone(),
        title: lab.title.clone(),
        source: lab.source_note.clone(),
        systems: points.chain(simulations).collect(),
        questions: lab.questions.len(),
        points: worth.as_f64(),
    }
}

/// Columns as wide as they must be; the systems on a line of their own, since there may be many.
fn table(rows: &[Row]) -> String {
    let width = |of: fn(&Row) -> &str, head: &str| {
        rows.iter().map(|row| of(row).chars().count()).chain([head.len()]).max().unwrap_or(0)
    };
    let (ids, titles) = (width(|row| &row.id, "id"), width(|row| &row.title, "title"));
    let mut text = format!("{:ids$}  {:titles$}  questions  points\n", "id", "title");
    for row in rows {
        text.push_str(&format!(
            "{:ids$}  {:titles$}  {:>9}  {:>6}\n{:ids$}    {}\n",
            row.id,
            row.title,
            row.questions,
            row.points,
            "",
            row.systems.join(", ")
        ));
    }
    text
}
