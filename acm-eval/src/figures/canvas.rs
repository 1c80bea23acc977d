//! One look for all figures: panels on white, a legend above, the data set's name below; SVG and PNG.

pub(crate) mod axis;
pub(crate) mod axonometry;
pub(crate) mod bars;
pub(crate) mod dark;
pub(super) mod drawing;
pub(crate) mod legend;
mod lettering;
pub mod palette;

use acm_train::run::record::DataStamp;
use kuva::render::{
    figure::Figure as Grid,
    layout::{Layout, TickFormat},
    plots::Plot,
    render::{Primitive, Scene, TextAnchor},
    theme::Theme,
};

use super::plotted::{self, areas, placed};
use axis::Scale;
use drawing::Drawing;
use legend::{Key, ROW, draw_key, legend_rows};
use lettering::{FONTS, TEXT, text};

const TITLE: u32 = 15;
const TICKS: u32 = 13;

/// Panels that are combined to a figure.
pub struct Panels {
    /// Number of panels in one row.
    pub columns: usize,
    /// Plots and layout of each panel, row by row.
    pub panels: Vec<(Vec<Plot>, Layout)>,
    /// Size of a panel, px.
    pub size: (f64, f64),
    /// Meaning of the colours and strokes.
    pub legend: Vec<Key>,
}

/// Returns a panel with round limits on both axes.
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
    /// Combines the panels to a figure.
    pub fn draw(self, data: &DataStamp, series: usize, explanation: String) -> Drawing {
        self.draw_finer(None, data, series, explanation)
    }

    /// Combines the panels to a figure where the numbers behind it are finer than the drawing: plots of each panel.
    pub fn draw_finer(
        self,
        finer: Option<Vec<Vec<Plot>>>,
        data: &DataStamp,
        series: usize,
        explanation: String,
    ) -> Drawing {
        let rows = self.panels.len().div_ceil(self.columns);
        let (plots, layouts): (Vec<_>, Vec<_>) = self.panels.into_iter().unzip();
        let behind = finer.as_ref().unwrap_or(&plots).iter().zip(&layouts);
        let behind = behind.map(|(plots, layout)| plotted::panel(plots, layout, &self.legend)).collect();
        let grid = Grid::new(rows, self.columns)
            .with_cell_size(self.size.0, self.size.1)
            .with_spacing(8.0)
            .with_padding(6.0)
            .with_plots(plots)
            .with_layouts(layouts)
            .render();
        let scene = framed(grid, &self.legend, data);
        let plotted = placed(behind, &areas(&scene.elements));
        Drawing { scene, explanation, series, plotted, space: None }
    }
}

/// Adds the legend above, and the data set below.
fn framed(grid: Scene, legend: &[Key], data: &DataStamp) -> Scene {
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
    let (content, colour) = match data.synthetic {
        true => (format!("{} — SYNTHETIC DATA, made by a simulator", data.name), palette::WARNING),
        false => (data.name.clone(), palette::FAINT),
    };
    let y = scene.height - 8.0;
    scene.add(text(16.0, y, content, TICKS, TextAnchor::Start, colour, data.synthetic));
    scene
}
