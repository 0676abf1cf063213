use super::canvas::{Anchor, BLACK, Canvas, GREY, PALE};
use super::{Axis, COLOURS, DrawResult};
use crate::statistics::Summary;
use std::path::Path;

/// One box: whiskers to the least and the worst, a box between the quartiles, a bar at the median, a dot at the mean.
pub(crate) struct BoxRow {
    /// Index into the legend; also the colour.
    pub(crate) kind: usize,
    pub(crate) summary: Summary,
}

/// Boxes under one name.
pub(crate) struct Group {
    pub(crate) name: String,
    /// A second, smaller line under the name.
    pub(crate) note: String,
    pub(crate) rows: Vec<BoxRow>,
}

/// Groups one below the other on a common logarithmic axis.
pub(crate) struct BoxPlot {
    pub(crate) title: String,
    pub(crate) axis: String,
    pub(crate) legend: Vec<String>,
    pub(crate) groups: Vec<Group>,
}

const ROW: f64 = 15.0;
const GAP: f64 = 14.0;
const LEFT: f64 = 205.0;
const WIDTH: f64 = 900.0;
const RIGHT: f64 = 30.0;

impl BoxPlot {
    pub(crate) fn draw(&self, path: &Path) -> DrawResult {
        let values =
            self.groups.iter().flat_map(|g| &g.rows).flat_map(|r| [r.summary.least, r.summary.worst]);
        let axis = Axis::decades(&self.axis, values);
        let lines = self.legend.len().div_ceil(4);
        let top = 52.0 + 20.0 * lines as f64;
        // At least two rows of height, so that the name and its note fit.
        let height_of = |group: &Group| (group.rows.len().max(2) as f64) * ROW + GAP;
        let bottom = top + self.groups.iter().map(height_of).sum::<f64>();
        let canvas = Canvas::new(path, (WIDTH as u32, bottom as u32 + 58))?;
        let x = |value: f64| LEFT + axis.place(value) * (WIDTH - LEFT - RIGHT);

        canvas.text((20.0, 22.0), &self.title, Anchor::Left, (19, BLACK))?;
        for (index, name) in self.legend.iter().enumerate() {
            let at = (20.0 + 215.0 * (index % 4) as f64, 50.0 + 20.0 * (index / 4) as f64);
            canvas.block(
                (at.0, at.1 - 5.0),
                (at.0 + 16.0, at.1 + 5.0),
                COLOURS[index % COLOURS.len()],
                0.75,
            )?;
            canvas.text((at.0 + 24.0, at.1), name, Anchor::Left, (14, BLACK))?;
        }
        for (value, label) in axis.ticks() {
            canvas.line(&[(x(value), top), (x(value), bottom)], PALE, 1)?;
            canvas.text((x(value), bottom + 14.0), &label, Anchor::Middle, (14, BLACK))?;
        }
        canvas.text(
            (0.5 * (LEFT + WIDTH - RIGHT), bottom + 38.0),
            &axis.label,
            Anchor::Middle,
            (15, BLACK),
        )?;

        let mut y = top;
        for group in &self.groups {
            canvas.line(&[(20.0, y), (WIDTH - RIGHT, y)], PALE, 1)?;
            let height = height_of(group);
            let middle = y + 0.5 * height;
            let shift = if group.note.is_empty() { 0.0 } else { 8.0 };
            canvas.text((LEFT - 12.0, middle - shift), &group.name, Anchor::Right, (14, BLACK))?;
            canvas.text((LEFT - 12.0, middle + 9.0), &group.note, Anchor::Right, (12, GREY))?;
            let first = middle - 0.5 * ROW * group.rows.len() as f64;
            for (index, row) in group.rows.iter().enumerate() {
                draw_box(&canvas, first + (index as f64 + 0.5) * ROW, row, x)?;
            }
            y += height;
        }
        canvas.line(&[(LEFT, top), (LEFT, bottom), (WIDTH - RIGHT, bottom)], BLACK, 1)?;
        canvas.finish()
    }
}

fn draw_box(canvas: &Canvas<'_>, y: f64, row: &BoxRow, x: impl Fn(f64) -> f64) -> DrawResult {
    let (s, shade) = (&row.summary, COLOURS[row.kind % COLOURS.len()]);
    canvas.line(&[(x(s.least), y), (x(s.worst), y)], shade, 1)?;
    for end in [s.least, s.worst] {
        canvas.line(&[(x(end), y - 3.0), (x(end), y + 3.0)], shade, 1)?;
    }
    // A box thinner than a pixel would vanish.
    let (from, to) = (x(s.lower), x(s.upper).max(x(s.lower) + 1.0));
    canvas.block((from, y - 5.0), (to, y + 5.0), shade, 0.55)?;
    canvas.line(&[(x(s.median), y - 6.0), (x(s.median), y + 6.0)], BLACK, 2)?;
    if s.mean > 0.0 {
        canvas.dot((x(s.mean), y), BLACK, 2)?;
    }
    Ok(())
}
