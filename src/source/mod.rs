//! Text with places in it: where something stands, what is wrong there, and how to show it.

mod finding;
mod separator;
mod source_text;
mod text;
mod yaml;

pub use finding::{Finding, Severity};
pub use separator::{StrayQuote, separator, stray_quote};
pub use source_text::{Position, SourceText, Span};
pub use text::{DecodeError, MAX_TEXT_BYTES, decode, decode_within, read_within, sanitize};
pub use yaml::{Node, Value, YamlError, parse, parse_of_class, parse_with_duplicates};
