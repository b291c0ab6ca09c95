//! The shape of a pupil, as text.

use tem00_report::args::positive;
use tem00_speckle::Pupil;

pub(super) fn pupil(text: &str) -> Result<Pupil, String> {
    let (name, proportion) = match text.split_once(':') {
        Some((name, proportion)) => (name, Some(positive(proportion)?)),
        None => (text, None),
    };
    match (name, proportion) {
        ("circle", None) => Ok(Pupil::Circle),
        ("annulus", inner) => Ok(Pupil::Annulus {
            inner: inner.unwrap_or(0.5),
        }),
        ("rectangle", height) => Ok(Pupil::Rectangle {
            height: height.unwrap_or(1.0),
        }),
        _ => Err("must be circle, annulus, annulus:INNER, rectangle or rectangle:HEIGHT".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pupils_carry_their_proportion() {
        let of = |text| pupil(text).ok();
        assert_eq!(of("circle"), Some(Pupil::Circle));
        assert_eq!(of("annulus"), Some(Pupil::Annulus { inner: 0.5 }));
        assert_eq!(of("annulus:0.3"), Some(Pupil::Annulus { inner: 0.3 }));
        assert_eq!(
            of("rectangle:0.25"),
            Some(Pupil::Rectangle { height: 0.25 })
        );
        for bad in [
            "circle:1",
            "square",
            "annulus:",
            "annulus:-1",
            "rectangle:nan",
        ] {
            assert!(of(bad).is_none(), "{bad} is no pupil");
        }
    }
}
