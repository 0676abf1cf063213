use super::canvas::{Anchor, BLACK, Canvas, PALE};
use super::{Axis, COLOURS, DrawResult};
use std::path::Path;

/// Points joined by a line; `spread` is drawn as a pale band.
pub(crate) struct Series {
    /// In the legend, with the fitted exponent if there is one.
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// Below and above each point; empty for none.
    pub(crate) spread: Vec<(f64, f64)>,
}

/// Lines over two axes.
pub(crate) struct LinePlot {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) series: Vec<Series>,
}

const SIZE: (f64, f64) = (820.0, 480.0);
const LEFT: f64 = 95.0;
const RIGHT: f64 = 30.0;
const BOTTOM: f64 = 70.0;

impl LinePlot {
    pub(crate) fn draw(&self, path: &Path) -> DrawResult {
        let canvas = Canvas::new(path, (SIZE.0 as u32, SIZE.1 as u32))?;
        let top = 52.0 + 20.0 * self.series.len().div_ceil(2) as f64;
        let low = SIZE.1 - BOTTOM;
        let place = |(x, y): (f64, f64)| {
            (LEFT + self.x.place(x) * (SIZE.0 - LEFT - RIGHT), low - self.y.place(y) * (low - top))
        };
        canvas.text((20.0, 22.0), &self.title, Anchor::Left, (19, BLACK))?;
        for (value, label) in self.x.ticks() {
            let x = place((value, self.y.lo)).0;
            canvas.line(&[(x, low), (x, top)], PALE, 1)?;
            canvas.text((x, low + 16.0), &label, Anchor::Middle, (14, BLACK))?;
        }
        for (value, label) in self.y.ticks() {
            let y = place((self.x.lo, value)).1;
            canvas.line(&[(LEFT, y), (SIZE.0 - RIGHT, y)], PALE, 1)?;
            canvas.text((LEFT - 8.0, y), &label, Anchor::Right, (14, BLACK))?;
        }
        canvas.text(
            (0.5 * (LEFT + SIZE.0 - RIGHT), low + 44.0),
            &self.x.label,
            Anchor::Middle,
            (15, BLACK),
        )?;
        canvas.upright((24.0, 0.5 * (low + top)), &self.y.label, 15)?;

        for (index, series) in self.series.iter().enumerate() {
            let shade = COLOURS[index % COLOURS.len()];
            let at = (20.0 + 400.0 * (index % 2) as f64, 50.0 + 20.0 * (index / 2) as f64);
            canvas.line(&[at, (at.0 + 22.0, at.1)], shade, 3)?;
            canvas.text((at.0 + 30.0, at.1), &series.name, Anchor::Left, (14, BLACK))?;
            for (&(x, _), &(lower, upper)) in series.points.iter().zip(&series.spread) {
                let (from, to) = (place((x, lower)), place((x, upper)));
                canvas.line(&[from, to], shade, 1)?;
                for end in [from, to] {
                    canvas.line(&[(end.0 - 4.0, end.1), (end.0 + 4.0, end.1)], shade, 1)?;
                }
            }
            let points: Vec<(f64, f64)> = series.points.iter().map(|&p| place(p)).collect();
            canvas.line(&points, shade, 2)?;
            for &point in &points {
                canvas.dot(point, shade, 4)?;
            }
        }
        canvas.line(&[(LEFT, top), (LEFT, low), (SIZE.0 - RIGHT, low)], BLACK, 1)?;
        canvas.finish()
    }
}
