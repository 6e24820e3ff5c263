//! Scorecard → view → figure → svg → html. Solves and awards nothing.
