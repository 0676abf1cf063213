//! Figures as SVG: horizontal box plots and line plots, on logarithmic axes with labelled decades.
mod axis;
mod box_plot;
mod canvas;
mod line_plot;

pub(crate) use axis::Axis;
pub(crate) use box_plot::{BoxPlot, BoxRow, Group};
pub(crate) use line_plot::{LinePlot, Series};

/// Colours that differ in lightness too, so that they stay apart for everybody and in print.
pub(crate) const COLOURS: [(u8, u8, u8); 7] = [
    (0, 90, 160),
    (214, 96, 0),
    (0, 140, 100),
    (170, 60, 130),
    (110, 110, 110),
    (200, 160, 0),
    (80, 50, 160),
];

/// What went wrong with drawing, as text.
pub(crate) type DrawResult = Result<(), Box<dyn std::error::Error>>;

#[cfg(test)]
mod tests;
