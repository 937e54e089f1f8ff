//! Placement of an instance: its part is translated, then rotated about an axis.

use super::keyword_block::KeywordBlock;
use crate::deck::fields::LineFields;
use crate::deck::source::DeckLines;
use crate::error::Result;

/// A translation followed by a rotation.
#[derive(Debug, Clone, Default)]
pub(super) struct Placement {
    shift: [f64; 3],
    turn: Option<AxisTurn>,
}

/// A rotation about an axis through a point.
#[derive(Debug, Clone)]
struct AxisTurn {
    point: [f64; 3],
    matrix: [[f64; 3]; 3],
}

impl Placement {
    /// Reads the data lines of `*INSTANCE`.
    ///
    /// # Errors
    /// `Input` for too many lines or values, and for a rotation that is incomplete or has no axis.
    pub(super) fn read(source: &DeckLines, block: &KeywordBlock) -> Result<Placement> {
        let mut out = Placement::default();
        let lines = &block.lines;
        if let Some(&line) = lines.first() {
            let mut row = block.fields(source, line);
            for x in &mut out.shift {
                *x = row.number_or("the translation", 0.0)?;
            }
            if !row.is_at_end() {
                return Err(row.place.error(
                    "the first line is the translation x, y, z; put a line 0., 0., 0. in front of \
                     a rotation alone",
                ));
            }
        }
        if let Some(&line) = lines.get(1) {
            out.turn = AxisTurn::read(block.fields(source, line))?;
        }
        block.no_more(source, 2)?;
        Ok(out)
    }

    /// Whether the instance leaves the coordinates of the part unchanged.
    pub(super) fn is_none(&self) -> bool {
        self.turn.is_none() && self.shift == [0.0; 3]
    }

    /// The position in the assembly of a point of the part.
    pub(super) fn point(&self, mut x: [f64; 3]) -> [f64; 3] {
        (0..3).for_each(|d| x[d] += self.shift[d]);
        let Some(turn) = &self.turn else { return x };
        let from_axis = std::array::from_fn(|d| x[d] - turn.point[d]);
        let turned = self.vector(from_axis);
        std::array::from_fn(|d| turn.point[d] + turned[d])
    }

    /// The direction in the assembly of a direction in the part.
    pub(super) fn vector(&self, x: [f64; 3]) -> [f64; 3] {
        let Some(turn) = &self.turn else { return x };
        turn.matrix
            .map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
    }
}

impl AxisTurn {
    /// Reads two points of the axis and the angle in degrees, by the right-hand rule; `None` if the
    /// rotation is the identity.
    fn read(mut row: LineFields) -> Result<Option<AxisTurn>> {
        let mut points = [[0.0; 3]; 2];
        for x in points.as_flattened_mut() {
            *x = row.number("a coordinate of the axis of rotation")?;
        }
        let degrees = row.number("the angle of rotation")?;
        row.end()?;
        let [from, to] = points;
        let along: [f64; 3] = std::array::from_fn(|d| to[d] - from[d]);
        let length = along[0].hypot(along[1]).hypot(along[2]);
        if length == 0.0 || !length.is_finite() {
            return Err(row.place.error(
                "the two points of the axis of rotation are the same or too far apart; give two \
                 points on it",
            ));
        }
        let [sine, cosine] = sine_and_cosine(degrees);
        if [sine, cosine] == [0.0, 1.0] {
            return Ok(None);
        }
        // O. Rodrigues, 1840: cos I + sin [a x] + (1 - cos) a a^T.
        let a = along.map(|x| x / length);
        let cross = [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]];
        let entry = |i: usize, j: usize| {
            let own = if i == j { cosine } else { 0.0 };
            own + sine * cross[i][j] + (1.0 - cosine) * a[i] * a[j]
        };
        let matrix = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
        let point = from;
        Ok(Some(AxisTurn { point, matrix }))
    }
}

/// Sine and cosine of an angle in degrees, exact for multiples of a right angle.
fn sine_and_cosine(degrees: f64) -> [f64; 2] {
    match degrees.rem_euclid(360.0) {
        0.0 | 360.0 => [0.0, 1.0],
        90.0 => [1.0, 0.0],
        180.0 => [0.0, -1.0],
        270.0 => [-1.0, 0.0],
        rest => [rest.to_radians().sin(), rest.to_radians().cos()],
    }
}
