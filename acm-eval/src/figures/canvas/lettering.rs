//! Words of all figures: their fonts, their size, their place.

use kuva::render::{
    color::Color,
    render::{Primitive, TextAnchor},
};

/// Size of labels and legends, px of a figure that is 900 px wide.
pub const TEXT: u32 = 14;
/// Fonts of the page; the PNG is drawn with a font of its own.
pub const FONTS: &str = "system-ui, 'Segoe UI', 'DejaVu Sans', Arial, sans-serif";

/// Returns words at a position.
pub fn text(x: f64, y: f64, content: String, size: u32, anchor: TextAnchor, colour: &str, bold: bool) -> Primitive {
    Primitive::Text { x, y, content, size, anchor, rotate: None, bold, color: Some(Color::from(colour)) }
}
