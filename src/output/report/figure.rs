//! Figures of the page.

use maud::{Markup, PreEscaped, html};

/// A drawing in its place on the page.
pub(super) struct Figure {
    /// Name of the figure, which is also its anchor in the page.
    pub name: String,
    /// Heading; empty if there is none.
    pub title: String,
    /// Caption that says what the figure shows.
    pub caption: String,
    /// The drawing as SVG text for the page.
    pub svg: String,
    /// Width and height of the figure, in units.
    pub size: [u32; 2],
}

/// Returns the name of a figure's drawing within the page.
pub(super) fn id(figure: &str) -> String {
    format!("svg-{figure}")
}

/// Lays out figures beside each other. Each figure is a link to itself as the target of the page;
/// the style lets the target fill the screen, with a link back over it, so enlarging needs no
/// script.
pub(super) fn figures(list: &[Figure], class: &str) -> Markup {
    html! {
        div class=(class) {
            @for figure in list {
                div.frame id={ "at-" (figure.name) } {
                    figure id={ "fig-" (figure.name) } {
                        @if !figure.title.is_empty() { h3 { (figure.title) } }
                        a.enlarge href={ "#fig-" (figure.name) } aria-label="Enlarge" {
                            (PreEscaped(&figure.svg))
                        }
                        @if !figure.caption.is_empty() { figcaption { (figure.caption) } }
                        a.close href={ "#at-" (figure.name) } aria-label="Close" { "\u{d7}" }
                    }
                }
            }
        }
    }
}
