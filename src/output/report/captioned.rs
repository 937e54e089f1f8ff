//! Drawings with their captions.

use super::drawing::Drawing;
use super::figure::{Figure, id};

/// A drawing with its title and caption.
pub(super) struct Captioned {
    /// Short name, for the file and the anchor in the page.
    pub name: String,
    /// Heading; empty if there is none.
    pub title: String,
    /// Caption that says what the drawing shows.
    pub caption: String,
    pub drawing: Drawing,
}

impl Captioned {
    /// The drawing as a figure of the page.
    pub fn figure(&self) -> Figure {
        let label = if self.title.is_empty() {
            &self.caption
        } else {
            &self.title
        };
        Figure {
            name: self.name.clone(),
            title: self.title.clone(),
            caption: self.caption.clone(),
            svg: self.drawing.inline(label, &id(&self.name)),
            size: self.drawing.size(),
        }
    }
}
