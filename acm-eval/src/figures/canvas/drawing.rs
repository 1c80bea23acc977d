//! A finished figure as SVG and as PNG.

use kuva::{
    backend::{raster::RasterBackend, svg::SvgBackend},
    render::render::Scene,
};

use super::lettering::FONTS;
use super::palette;
use crate::error::EvalError;
use crate::figures::plotted::space::Space;
use crate::figures::plotted::{PlottedPanel, numbers};

/// Number of pixels of the PNG per px.
const DENSITY: f32 = 2.0;

/// A finished figure.
pub struct Drawing {
    /// Drawn elements, px.
    pub scene: Scene,
    /// Words below the figure: its contents, and how it was thinned.
    pub explanation: String,
    /// Number of drawn series, over all panels.
    pub series: usize,
    /// The numbers behind it; empty where the figure is no lines and dots.
    pub plotted: Vec<PlottedPanel>,
    /// Data of the figure in space, which the page's script turns.
    pub space: Option<Space>,
}

impl Drawing {
    /// Returns the width, px.
    pub fn width(&self) -> f64 {
        self.scene.width
    }

    /// Returns a scalable picture that scripts and screen readers can name: `title` is its question, `description` how
    /// it was made. Identifiers start with `id`, so that several can stand on one page.
    pub fn svg(&self, id: &str, title: &str, description: &str) -> String {
        let svg = own_identifiers(&SvgBackend::new().render_scene(&self.scene), id);
        let body = svg.split_once('>').map_or("", |(_, body)| body);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" \
             aria-labelledby=\"{id}-title {id}-desc\" font-family=\"{fonts}\" fill=\"{ink}\">\n\
             <title id=\"{id}-title\">{title}</title><desc id=\"{id}-desc\">{description}</desc>{body}",
            w = self.scene.width.round(),
            h = self.scene.height.round(),
            fonts = escaped(FONTS),
            ink = palette::INK,
            title = escaped(title),
            description = escaped(description),
        )
    }

    /// Returns whether there are numbers behind it that are no table beside it.
    pub fn has_numbers(&self) -> bool {
        self.space.is_some() || !self.plotted.is_empty()
    }

    /// Returns the numbers behind it as a table; none for a picture of a table that is printed beside it.
    pub fn csv(&self) -> Option<String> {
        match &self.space {
            Some(space) => Some(space.csv()),
            None => (!self.plotted.is_empty()).then(|| numbers::csv(&self.plotted)),
        }
    }

    /// Returns the figure as PNG.
    ///
    /// # Errors
    /// The picture is too large to be drawn.
    pub fn png(&self, name: &str) -> Result<Vec<u8>, EvalError> {
        let drawn = RasterBackend::new().with_scale(DENSITY).render_scene(&self.scene);
        drawn.map_err(|reason| EvalError::Figure { name: name.into(), reason })
    }
}

/// Numbers the clip paths within the figure, so that the same records give the same bytes. The plotting library numbers
/// them through the whole process.
fn own_identifiers(svg: &str, id: &str) -> String {
    const PREFIX: &str = "kuva-clip-";
    let mut numbers: Vec<&str> = Vec::new();
    let mut pieces = svg.split(PREFIX);
    let mut own = pieces.next().unwrap_or("").to_string();
    for piece in pieces {
        let end = piece.find(|c: char| !c.is_ascii_digit()).unwrap_or(piece.len());
        let (number, rest) = piece.split_at(end);
        let index = numbers.iter().position(|known| *known == number).unwrap_or_else(|| {
            numbers.push(number);
            numbers.len() - 1
        });
        own.push_str(&format!("{id}-clip-{index}"));
        own.push_str(rest);
    }
    own
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clip_paths_are_numbered_within_the_figure() {
        let svg = r#"<clipPath id="kuva-clip-41"/><g clip-path="url(#kuva-clip-41)"/><clipPath id="kuva-clip-7"/>"#;
        let own = r#"<clipPath id="f-clip-0"/><g clip-path="url(#f-clip-0)"/><clipPath id="f-clip-1"/>"#;
        assert_eq!(own_identifiers(svg, "f"), own);
    }
}
