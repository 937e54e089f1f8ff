//! Reading of loads on the volume of elements.

use crate::deck::data::VolumeLoad;
use crate::deck::fields::{LineFields, shown};
use crate::error::Result;

/// The kind of load that a line of `*DLOAD` gives.
pub(super) enum OnVolume {
    /// A load on faces of elements.
    Face,
    /// A load on the volume, with its size.
    Load(VolumeLoad, f64),
    /// A load that brinell does not have, with the reason.
    Refused(String),
}

/// Reads a load on the volume of elements; reads nothing of a load on faces.
pub(super) fn volume_load(mut row: LineFields) -> Result<OnVolume> {
    let word = row.word();
    if word
        .first()
        .is_some_and(|first| first.eq_ignore_ascii_case(&b'P'))
        && word.len() == 2
    {
        return Ok(OnVolume::Face);
    }
    let word = shown(word).to_uppercase();
    let unit = |way: [f64; 3]| {
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        (length > 0.0).then(|| way.map(|x| x / length))
    };
    match word.as_str() {
        "GRAV" => {
            let size = row.number("the acceleration")?;
            let way = vector(&mut row, "a component of the direction")?;
            row.end()?;
            let Some(way) = unit(way) else {
                return Err(row.place.error("the direction of GRAV has no length"));
            };
            Ok(OnVolume::Load(VolumeLoad::Acceleration(way), size))
        }
        "CENTRIF" => {
            let square = row.number("the square of the speed")?;
            let point = vector(&mut row, "a coordinate of the axis")?;
            let way = vector(&mut row, "a component of the axis")?;
            row.end()?;
            let Some(way) = unit(way).filter(|_| square >= 0.0) else {
                let message = "the axis of CENTRIF has no length, or the square of the speed is \
                               negative";
                return Err(row.place.error(message));
            };
            Ok(OnVolume::Load(VolumeLoad::Rotation([point, way]), square))
        }
        "BX" | "BY" | "BZ" | "NEWTON" => Ok(OnVolume::Refused(format!(
            "{word}: of loads on volumes GRAV and CENTRIF are there"
        ))),
        _ => Ok(OnVolume::Refused(format!(
            "{word}: of loads on elements pressures on faces, P1 to P6, GRAV and CENTRIF are there"
        ))),
    }
}

fn vector(row: &mut LineFields, what: &str) -> Result<[f64; 3]> {
    let mut out = [0.0; 3];
    for x in &mut out {
        *x = row.number_or(what, 0.0)?;
    }
    Ok(out)
}
