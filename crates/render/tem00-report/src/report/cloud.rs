//! Points in space, seen from a side that the reader may change.

use core::fmt::Write as _;

use super::escape::escaped;
use crate::{
    digits::rounded,
    plot::{height_colour, is_drawn},
};

/// The script that turns the points; without it they stand as in print.
pub(super) const SCRIPT: &str = include_str!("cloud.js");

/// The maximum number of points that are drawn.
pub(super) const MAX_POINTS: usize = 6_000;

/// The number of colours.
const COLOURS: usize = 32;

/// The direction from which the points are seen at first, in degrees.
const AZIMUTH: f64 = 30.0;
const ELEVATION: f64 = 35.0;

/// The half diagonal of the box, in tenths of a unit of the drawing.
const RADIUS: f64 = 2100.0;

/// The minimum ratio of a side of the box to its longest: shorter ones are stretched.
const MIN_SIDE: f64 = 0.25;

/// Points along the line, along the scan and up, with the names of the axes.
#[derive(Clone, Debug)]
pub struct Cloud<'a> {
    /// The names of the axes, with their units.
    pub labels: [&'a str; 3],
    /// `true` if the first two axes have the unit of the third.
    pub to_scale: bool,
    /// The points; points that are not finite are left out.
    pub points: Vec<[f64; 3]>,
}

/// The box about the points, in units of the drawing.
struct Frame {
    low: [f64; 3],
    high: [f64; 3],
    /// Tenths of a unit of the drawing per unit of an axis.
    scale: [f64; 3],
}

impl Cloud<'_> {
    /// Returns the drawing and its caption, or nothing without points.
    pub(super) fn draw(mut self) -> Option<(String, String)> {
        self.points
            .retain(|point| point.iter().all(|x| x.is_finite()));
        let frame = Frame::about(&self.points, self.to_scale)?;
        let count = self.points.len();
        let drawn = self.points.iter().enumerate();
        let drawn = drawn.filter(|&(index, _)| is_drawn(index, count, MAX_POINTS));
        let mut dots = vec![Vec::new(); COLOURS];
        for (_, point) in drawn {
            dots[frame.colour(point[2])].push(frame.place(*point));
        }
        let shown: usize = dots.iter().map(Vec::len).sum();
        let mut svg = format!(
            "<svg class=\"cloud\" viewBox=\"-310 -215 620 430\" width=\"620\" height=\"430\" \
             data-azimuth=\"{AZIMUTH}\" data-elevation=\"{ELEVATION}\">"
        );
        path(&mut svg, "edges", "currentColor", &frame.edges());
        for (index, dots) in dots.iter().enumerate().filter(|(_, dots)| !dots.is_empty()) {
            path(&mut svg, "dots", &height_colour(middle(index)), dots);
        }
        self.write_labels(&frame, &mut svg);
        svg.push_str("</svg>");
        let number = if shown == count {
            format!("The {count} valid points")
        } else {
            format!("{shown} of the {count} valid points, evenly chosen")
        };
        let caption = format!("{number}, coloured by height; {}.", self.stretch(&frame));
        Some((svg, caption))
    }

    /// Writes the names of the axes and where they begin and end.
    fn write_labels(&self, frame: &Frame, svg: &mut String) {
        for axis in 0..3 {
            let Frame { low, high, .. } = frame;
            let ends = [low[axis], high[axis]].map(|value| rounded(value, 3));
            let middle = f64::midpoint(low[axis], high[axis]);
            let texts = [
                (low[axis], &*ends[0]),
                (middle, self.labels[axis]),
                (high[axis], &*ends[1]),
            ];
            for (value, text) in texts {
                let [x, y, z] = frame.label(axis, value);
                let (across, up) = projected([x, y, z]);
                let text = escaped(text);
                // Writing to memory never fails.
                let _ = write!(
                    svg,
                    "<text class=\"label\" data-p=\"{x:.0} {y:.0} {z:.0}\" \
                     transform=\"translate({across:.1} {up:.1})\">{text}</text>"
                );
            }
        }
    }

    fn stretch(&self, frame: &Frame) -> String {
        if !self.to_scale {
            return "the axes have scales of their own".to_owned();
        }
        let min = frame.scale.into_iter().fold(f64::MAX, f64::min);
        let names = ["along the line", "along the scan", "heights"];
        let stretched = names.iter().zip(frame.scale).filter_map(|(name, scale)| {
            let factor = scale / min;
            (factor > 1.001).then(|| format!("{name} stretched {} times", rounded(factor, 2)))
        });
        let stretched: Vec<_> = stretched.collect();
        if stretched.is_empty() {
            "to scale".to_owned()
        } else {
            stretched.join(", ")
        }
    }
}

impl Frame {
    /// Returns the box about points, unless there are none or all coincide.
    fn about(points: &[[f64; 3]], to_scale: bool) -> Option<Self> {
        let bound = |axis: usize, start: f64, keep: fn(f64, f64) -> f64| {
            points.iter().map(|point| point[axis]).fold(start, keep)
        };
        let low = [0, 1, 2].map(|axis| bound(axis, f64::MAX, f64::min));
        let high = [0, 1, 2].map(|axis| bound(axis, f64::MIN, f64::max));
        let spans = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        let longest = spans.into_iter().fold(0.0, f64::max);
        if points.is_empty() || !longest.is_finite() || longest <= 0.0 {
            return None;
        }
        // Sides relative to the longest.
        let wanted = [1.0, 0.6, 0.35];
        let sides = [0, 1, 2].map(|axis| {
            if spans[axis] <= 0.0 {
                0.0
            } else if to_scale {
                (spans[axis] / longest).max(MIN_SIDE)
            } else {
                wanted[axis]
            }
        });
        let diagonal = sides.iter().map(|side| side * side).sum::<f64>().sqrt();
        let scale = [0, 1, 2].map(|axis| {
            let per_length = if spans[axis] > 0.0 {
                sides[axis] / spans[axis]
            } else {
                longest.recip()
            };
            2.0 * RADIUS * per_length / diagonal
        });
        Some(Self { low, high, scale })
    }

    /// Returns a position in the box, about its middle, in tenths of a unit of the drawing.
    fn place(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let middle = f64::midpoint(self.low[axis], self.high[axis]);
            ((point[axis] - middle) * self.scale[axis]).round()
        })
    }

    /// Returns the number of the colour of a height.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to the number of colours"
    )]
    fn colour(&self, height: f64) -> usize {
        let span = (self.high[2] - self.low[2]).max(f64::MIN_POSITIVE);
        let share = (height - self.low[2]) / span;
        ((share * COLOURS as f64) as usize).min(COLOURS - 1)
    }

    /// Returns the positions of the ends of the edges of the box.
    fn edges(&self) -> Vec<[f64; 3]> {
        let ends = [self.low, self.high];
        let mut edges = Vec::new();
        for axis in 0..3 {
            for (b, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                for a in 0..2 {
                    let mut corner = [0.0; 3];
                    corner[axis] = ends[a][axis];
                    corner[(axis + 1) % 3] = ends[b][(axis + 1) % 3];
                    corner[(axis + 2) % 3] = ends[c][(axis + 2) % 3];
                    edges.push(self.place(corner));
                }
            }
        }
        edges
    }

    /// Returns where a label of an axis stands, outside of an edge of the box that is in front at
    /// first.
    fn label(&self, axis: usize, value: f64) -> [f64; 3] {
        const OUT: f64 = 400.0;
        let mut point = [self.low[0], self.low[1], self.low[2]];
        if axis == 1 {
            point[0] = self.high[0];
        }
        point[axis] = value;
        let mut place = self.place(point);
        match axis {
            0 => place[1] -= OUT,
            1 => place[0] += OUT,
            _ => place[0] -= OUT,
        }
        place
    }
}

/// Returns the initial projection of a position, in units of the drawing, across and down.
fn projected([x, y, z]: [f64; 3]) -> (f64, f64) {
    let (sa, ca) = AZIMUTH.to_radians().sin_cos();
    let (se, ce) = ELEVATION.to_radians().sin_cos();
    let up = z * ce + (y * ca - x * sa) * se;
    ((x * ca + y * sa) / 10.0, -up / 10.0)
}

/// Writes dots or edges as one element.
fn path(svg: &mut String, class: &str, colour: &str, places: &[[f64; 3]]) {
    let (mut positions, mut d) = (String::new(), String::new());
    for (index, &[x, y, z]) in places.iter().enumerate() {
        let (across, down) = projected([x, y, z]);
        let (command, end) = match class {
            "dots" => ("M", "h0"),
            _ if index % 2 == 0 => ("M", ""),
            _ => ("L", ""),
        };
        let space = if index == 0 { "" } else { " " };
        // Writing to memory never fails.
        let _ = write!(positions, "{space}{x:.0} {y:.0} {z:.0}");
        let _ = write!(d, "{command}{across:.1} {down:.1}{end}");
    }
    let _ = write!(
        svg,
        "<path class=\"{class}\" stroke=\"{colour}\" data-p=\"{positions}\" d=\"{d}\"/>"
    );
}

/// Returns the middle of the heights of a colour, from 0 to 1.
fn middle(colour: usize) -> f64 {
    (colour as f64 + 0.5) / COLOURS as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(points: Vec<[f64; 3]>) -> Option<(String, String)> {
        let cloud = Cloud {
            labels: ["x (mm)", "y (mm)", "<z> (mm)"],
            to_scale: true,
            points,
        };
        cloud.draw()
    }

    fn attribute<'a>(svg: &'a str, before: &str, name: &str) -> &'a str {
        let (_, rest) = svg.split_once(before).expect(before);
        let (_, rest) = rest.split_once(&format!(" {name}=\"")).expect(name);
        rest.split_once('"').expect("it ends").0
    }

    #[test]
    fn a_cube_is_seen_as_a_cube() {
        let corners = (0..8_u8).map(|n| [n & 1, n >> 1 & 1, n >> 2].map(f64::from));
        let (svg, caption) = cloud(corners.collect()).expect("points");
        assert_eq!(caption, "The 8 valid points, coloured by height; to scale.");
        // Of a cube about the origin with half sides r / √3, the corner (-, -, -) lies across at
        // -cos(a - 45°) √(2/3) r, and those of one edge upwards are cos(e) 2r / √3 apart.
        let d = attribute(&svg, "class=\"dots\"", "d");
        let places: Vec<(f64, f64)> = d
            .split("h0")
            .filter_map(|dot| dot.strip_prefix('M')?.split_once(' '))
            .map(|(x, y)| (x.parse().expect("a number"), y.parse().expect("a number")))
            .collect();
        assert_eq!(places.len(), 4, "the lower corners");
        assert!(
            places[2].1 < places[0].1,
            "from above: what is behind stands higher"
        );
        let expected = -15.0_f64.to_radians().cos() * (2.0_f64 / 3.0).sqrt() * 210.0;
        assert!(
            (places[0].0 - expected).abs() < 0.2,
            "{places:?}, {expected}"
        );
        let (_, rest) = svg.split_once(">0</text>").expect("labels");
        assert!(rest.contains("&lt;z&gt; (mm)"), "names are text");
        let all: Vec<f64> = svg
            .split("h0")
            .filter_map(|dot| dot.rsplit_once('M')?.1.split_once(' ')?.1.parse().ok())
            .collect();
        let upwards = 35.0_f64.to_radians().cos() * 2.0 / 3.0_f64.sqrt() * 210.0;
        assert!(
            (all[0] - all[4] - upwards).abs() < 0.2,
            "{all:?}, {upwards}"
        );
    }

    #[test]
    fn many_points_are_thinned_and_the_caption_says_so() {
        let count = 50_000_u32;
        let points = (0..count).map(|n| [f64::from(n % 500), f64::from(n / 500), 1.0]);
        let (svg, caption) = cloud(points.collect()).expect("points");
        let drawn = svg.matches("h0").count();
        assert!(drawn.abs_diff(MAX_POINTS) < 20, "{drawn}");
        let said = format!("{drawn} of the 50000 valid points");
        assert!(caption.starts_with(&said), "{caption}");
        // 99 / 499 is less than a quarter.
        assert!(
            caption.ends_with("; along the scan stretched 1.3 times."),
            "{caption}"
        );
    }

    #[test]
    fn what_has_no_place_is_left_out() {
        assert!(cloud(Vec::new()).is_none());
        assert!(cloud(vec![[f64::NAN, 0.0, 0.0]; 3]).is_none());
        assert!(cloud(vec![[1.0, 2.0, 3.0]; 3]).is_none());
        let (svg, _) = cloud(vec![[0.0; 3], [1.0; 3], [f64::NAN; 3]]).expect("points");
        assert!(
            !svg.contains("NaN") && svg.matches("h0").count() == 2,
            "{svg}"
        );
    }
}
