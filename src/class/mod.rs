//! Many submissions: in parallel, gradebook, statistics. Judges nothing.
