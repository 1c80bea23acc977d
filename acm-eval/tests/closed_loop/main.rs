//! What is shown of a finding: complete, marked where synthetic, and whole whatever the numbers are.

mod beside;
#[path = "../browser/mod.rs"]
mod browser;
mod figures;
mod findings;
mod pages;
mod sentences;
mod summaries;

/// Words of a page outside of tags, styles and drawings.
fn words(html: &str) -> String {
    let body = html.split_once("<body>").map_or(html, |(_, body)| body);
    // What is between the end of one script and the beginning of the next.
    let body: String = body.split("</script>").map(|part| part.split("<script").next().unwrap_or("")).collect();
    let mut text = String::new();
    for piece in body.split('<') {
        let shown = piece.split_once('>').map_or("", |(_, shown)| shown);
        text.push_str(shown);
        text.push(' ');
    }
    text.replace('\u{a0}', " ").split_whitespace().collect::<Vec<_>>().join(" ")
}
