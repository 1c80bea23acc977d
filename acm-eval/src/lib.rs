//! Judging runs: tables, figures and one self-contained page, drawn from records.
