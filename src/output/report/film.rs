//! Films: the pictures of the states shown one after the other by CSS alone. A picture of the page
//! is not repeated, but referred to by its name.

use super::drawing::{FINE, LETTERS, escaped};
use super::figure::{Figure, id};
use super::states::{MAGNIFIED, of_state};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Returns a film for each picture that several states have in the same scale. Magnified shapes are
/// left out, because each has its own scale.
pub(super) fn of(states: &[(String, Vec<Figure>)]) -> Vec<Figure> {
    let mut films: BTreeMap<&str, Vec<(&str, &Figure)>> = BTreeMap::new();
    for (state, figures) in states {
        for figure in figures {
            let scenes = films.entry(of_state(&figure.name)).or_default();
            scenes.push((state, figure));
        }
    }
    films.retain(|name, scenes| scenes.len() > 1 && !name.starts_with(MAGNIFIED));
    films
        .into_iter()
        .map(|(name, scenes)| film(name, &scenes))
        .collect()
}

fn film(name: &str, scenes: &[(&str, &Figure)]) -> Figure {
    let size = scenes.iter().fold([0; 2], |[w, h], (_, figure)| {
        [w.max(figure.size[0]), h.max(figure.size[1])]
    });
    // The line of text above the pictures.
    let line = (1.6 * LETTERS) as u32 * FINE;
    let [width, height] = size;
    let letters = LETTERS * f64::from(FINE);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"film film-{}\" \
         viewBox=\"0 0 {width} {}\" \
         font-size=\"{letters}\" role=\"img\" aria-label=\"The states one after the other\">\n",
        scenes.len(),
        height + line
    );
    for (index, (state, figure)) in scenes.iter().enumerate() {
        let [width, height] = figure.size;
        let at = f64::from(line) - 0.5 * letters;
        let _ = writeln!(
            svg,
            "<g style=\"--scene:{index}\"><text x=\"{letters}\" y=\"{at}\" fill=\"currentColor\">{}\
             </text><use href=\"#{}\" y=\"{line}\" width=\"{width}\" height=\"{height}\"/></g>",
            escaped(state),
            id(&figure.name)
        );
    }
    svg.push_str("</svg>");
    Figure {
        name: format!("film_{name}"),
        title: String::new(),
        caption: String::new(),
        svg,
        size: [width, height + line],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(name: &str) -> Figure {
        Figure {
            name: name.into(),
            title: String::new(),
            caption: String::new(),
            svg: String::new(),
            size: [800, 600],
        }
    }

    /// A film consists of the pictures that both states have, in order; a picture of one state
    /// alone makes no film.
    #[test]
    fn films_are_of_pictures_that_several_states_have() {
        let states = [
            ("first <1>".to_string(), vec![figure("state_01_von_mises")]),
            (
                "second".to_string(),
                vec![
                    figure("state_03_von_mises"),
                    figure("state_03_plastic_zone"),
                ],
            ),
        ];
        let films = of(&states);
        assert_eq!(films.len(), 1);
        assert_eq!(films[0].name, "film_von_mises");
        let svg = &films[0].svg;
        let [first, second] = ["#svg-state_01_von_mises", "#svg-state_03_von_mises"];
        assert!(svg.find(first).unwrap() < svg.find(second).unwrap());
        assert!(
            svg.contains("film-2") && svg.contains("first &lt;1>"),
            "{svg}"
        );
    }
}
