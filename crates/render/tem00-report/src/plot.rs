//! Diagrams: charts of points and lines, bars and heat maps, as SVG and PNG.

mod bars;
mod cells;
mod chart;
pub mod colours;
mod drawing;
mod heat_map;

pub use self::{
    bars::Bars,
    chart::Chart,
    colours::Colour,
    drawing::{Drawing, PlotFormat},
    heat_map::{HeatMap, Scale, height_colour},
};

/// Returns whether an item is among the at most `max` of `count` items that are drawn: all of few
/// items, and of many items a selection that is spread evenly over all of them, as multiples of the
/// golden ratio are.
pub fn is_drawn(index: usize, count: usize, max: usize) -> bool {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (GOLDEN * index as f64).fract() * count as f64 <= max as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_items_are_all_drawn_and_of_many_an_even_part() {
        let max = 4_000;
        assert!((0..max).all(|index| is_drawn(index, max, max)), "few");
        let count = 200_000;
        // Of each tenth, as a parameter of ten values has them, a tenth: to a few by the
        // discrepancy of the golden ratio, 1 + log₂ of the number.
        for remainder in 0..10 {
            let tenth = (0..count).filter(|index| index % 10 == remainder);
            let drawn = tenth.filter(|&index| is_drawn(index, count, max)).count();
            assert!(drawn.abs_diff(max / 10) <= 18, "{remainder}: {drawn}");
        }
    }
}
