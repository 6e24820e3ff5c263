//! What English sentences say: words, phrases and their denials, claims about a response. Knows no lab and no student.

mod claims;
mod context;
mod number;
mod phrase;
mod sentence;
mod truth;
mod values;
mod vocabulary;
mod words;

pub use claims::{Claim, ClaimKind, Quantity, claims};
pub use number::ClaimedNumber;
pub use phrase::{Phrase, Said};
pub use sentence::{Sentence, sentences};
pub use words::{Gap, Token, normalized};
