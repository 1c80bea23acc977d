//! Studies of the embedded campaign on the page: every number of their tables is computed again from the predictions on the
//! disk, and a browser looks at the page.

mod again;
#[path = "../browser/mod.rs"]
mod browser;
mod conducted;
mod csv;
mod page;
