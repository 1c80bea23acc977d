//! One look for all figures: panels on white, a legend above, the data set's name below; SVG and PNG.

use kuva::{
    backend::{raster::RasterBackend, svg::SvgBackend},
    render::{
        color::Color,
        figure::Figure as Grid,
        layout::{Layout, TickFormat},
        plots::Plot,
        render::{Primitive, Scene, TextAnchor},
        theme::Theme,
    },
};

use super::{axis::Scale, palette};
use crate::{error::EvalError, section::Section};

/// Text sizes, px of a figure that is 900 px wide.
const TITLE: u32 = 15;
const TEXT: u32 = 14;
const TICKS: u32 = 13;
/// Pixels of the PNG per px.
const DENSITY: f32 = 2.0;
/// Fonts of the page; the PNG is drawn with a font of its own.
const FONTS: &str = "system-ui, 'Segoe UI', 'DejaVu Sans', Arial, sans-serif";

/// A finished figure.
pub struct Drawing {
    scene: Scene,
    /// Words below the figure: what is drawn, and how it was thinned.
    pub explanation: String,
    /// Number of drawn series, over all panels.
    pub series: usize,
}

/// Panels to be put together.
pub struct Panels {
    /// Panels in one row.
    pub columns: usize,
    /// Plots and layout of each, row by row.
    pub panels: Vec<(Vec<Plot>, Layout)>,
    /// Size of a panel, px.
    pub size: (f64, f64),
    /// What the colours and strokes mean.
    pub legend: Vec<Key>,
}

/// One entry of a legend.
pub struct Key {
    /// What it stands for.
    pub label: String,
    /// `#rrggbb`.
    pub colour: String,
    /// Its shape.
    pub mark: Mark,
}

/// The shape of a legend entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A filled bar.
    Bar,
    /// A solid line.
    Line,
    /// A dashed line.
    Dashes,
    /// A dot.
    Dot,
}

/// A panel with round limits on both axes.
pub fn panel(title: &str, x: (&str, Scale), y: (&str, Scale)) -> Layout {
    let layout = Layout::new((x.1.low, x.1.high), (y.1.low, y.1.high))
        .with_x_axis_min(x.1.low)
        .with_x_axis_max(x.1.high)
        .with_x_tick_step(x.1.step)
        .with_y_axis_min(y.1.low)
        .with_y_axis_max(y.1.high)
        .with_y_tick_step(y.1.step)
        .with_x_label(x.0)
        .with_y_label(y.0);
    let layout = if title.is_empty() { layout } else { layout.with_title(title) };
    layout
        .with_theme(theme())
        .with_font_family(FONTS)
        .with_title_size(TITLE)
        .with_label_size(TEXT)
        .with_tick_size(TICKS)
        .with_body_size(TICKS)
        .with_tick_format(TickFormat::Auto)
}

fn theme() -> Theme {
    let ink = || palette::INK.to_string();
    Theme {
        axis_color: ink(),
        tick_color: ink(),
        text_color: ink(),
        grid_color: palette::GRID.into(),
        font_family: Some(FONTS.into()),
        ..Theme::light()
    }
}

impl Panels {
    /// Puts the panels together.
    pub fn draw(self, section: &Section, series: usize, explanation: String) -> Drawing {
        let rows = self.panels.len().div_ceil(self.columns);
        let (plots, layouts): (Vec<_>, Vec<_>) = self.panels.into_iter().unzip();
        let grid = Grid::new(rows, self.columns)
            .with_cell_size(self.size.0, self.size.1)
            .with_spacing(8.0)
            .with_padding(6.0)
            .with_plots(plots)
            .with_layouts(layouts)
            .render();
        let scene = framed(grid, &self.legend, section);
        Drawing { scene, explanation, series }
    }
}

/// Legend above, data set below.
fn framed(grid: Scene, legend: &[Key], section: &Section) -> Scene {
    let width = grid.width;
    let keys = legend_rows(legend, width);
    let (above, below) = (ROW * keys.len() as f64 + 8.0, 24.0);
    let mut scene = Scene::new(width, grid.height + above + below);
    scene.font_family = Some(FONTS.into());
    scene.text_color = Some(palette::INK.into());
    scene.background_color = Some("white".into());
    scene.defs = grid.defs;
    for (row, keys) in keys.iter().enumerate() {
        keys.iter().for_each(|(x, key)| draw_key(&mut scene, *x, 8.0 + ROW * (row as f64 + 0.5), key));
    }
    let transform = Some(format!("translate(0,{above})"));
    scene.add(Primitive::GroupStart { transform, title: None, extra_attrs: None });
    grid.elements.into_iter().for_each(|element| scene.add(element));
    scene.add(Primitive::GroupEnd);
    let (content, colour) = match section.data.synthetic {
        true => (format!("{} — SYNTHETIC DATA, made by a simulator", section.data.name), palette::WARNING),
        false => (section.data.name.clone(), palette::FAINT),
    };
    let y = scene.height - 8.0;
    scene.add(text(width - 10.0, y, content, TICKS, TextAnchor::End, colour, section.data.synthetic));
    scene
}

/// Height of a row of the legend, px.
const ROW: f64 = 22.0;

/// Entries from left to right, in as many rows as the width asks for.
fn legend_rows(legend: &[Key], width: f64) -> Vec<Vec<(f64, &Key)>> {
    let mut rows: Vec<Vec<(f64, &Key)>> = Vec::new();
    let mut x = f64::INFINITY;
    for key in legend {
        let needed = 44.0 + 0.62 * f64::from(TEXT) * key.label.chars().count() as f64;
        if x + needed > width {
            rows.push(vec![]);
            x = 16.0;
        }
        rows.last_mut().expect("a row was opened").push((x, key));
        x += needed;
    }
    rows
}

fn draw_key(scene: &mut Scene, x: f64, y: f64, key: &Key) {
    let fill = Color::from(key.colour.as_str());
    let line = |dash: Option<&str>| Primitive::Line {
        x1: x,
        y1: y,
        x2: x + 24.0,
        y2: y,
        stroke: fill.clone(),
        stroke_width: 2.5,
        stroke_dasharray: dash.map(String::from),
    };
    scene.add(match key.mark {
        Mark::Line => line(None),
        Mark::Dashes => line(Some("6 4")),
        Mark::Bar => Primitive::Rect {
            x: x + 4.0,
            y: y - 7.0,
            width: 16.0,
            height: 14.0,
            fill,
            stroke: None,
            stroke_width: None,
            opacity: None,
        },
        Mark::Dot => Primitive::Circle {
            cx: x + 12.0,
            cy: y,
            r: 5.0,
            fill,
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        },
    });
    scene.add(text(x + 30.0, y + 5.0, key.label.clone(), TEXT, TextAnchor::Start, palette::INK, false));
}

fn text(x: f64, y: f64, content: String, size: u32, anchor: TextAnchor, colour: &str, bold: bool) -> Primitive {
    Primitive::Text { x, y, content, size, anchor, rotate: None, bold, color: Some(Color::from(colour)) }
}

impl Drawing {
    /// Width, px.
    pub fn width(&self) -> f64 {
        self.scene.width
    }

    /// A scalable picture that scripts and screen readers can name: `title` is its question, `description` how it was
    /// made. Identifiers start with `id`, so that several can stand on one page.
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

    /// The same as pixels.
    ///
    /// # Errors
    /// The picture is too large to be drawn.
    pub fn png(&self, name: &str) -> Result<Vec<u8>, EvalError> {
        let drawn = RasterBackend::new().with_scale(DENSITY).render_scene(&self.scene);
        drawn.map_err(|reason| EvalError::Figure { name: name.into(), reason })
    }
}

/// The plotting library numbers its clip paths through the whole process; here they are numbered within the figure, so
/// that the same records give the same bytes.
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

    #[test]
    fn a_long_legend_takes_another_row() {
        let key = || Key { label: "a network of some name".into(), colour: "#000000".into(), mark: Mark::Line };
        let keys: Vec<Key> = (0..5).map(|_| key()).collect();
        let rows = legend_rows(&keys, 600.0);
        assert_eq!(rows.iter().map(Vec::len).sum::<usize>(), 5);
        assert_eq!(rows.len(), 3);
    }
}
