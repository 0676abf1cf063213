//! Lines, boxes and words on an SVG page, in pixels.
use super::DrawResult;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;

/// Where text stands relative to its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Left,
    Right,
    Middle,
}

/// A white page.
pub(super) struct Canvas<'a>(DrawingArea<SVGBackend<'a>, Shift>);

pub(super) const BLACK: (u8, u8, u8) = (20, 20, 20);
pub(super) const GREY: (u8, u8, u8) = (95, 95, 95);
pub(super) const PALE: (u8, u8, u8) = (225, 225, 225);

fn colour((r, g, b): (u8, u8, u8)) -> RGBColor {
    RGBColor(r, g, b)
}

fn pixels((x, y): (f64, f64)) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

impl<'a> Canvas<'a> {
    pub(super) fn new(path: &'a Path, size: (u32, u32)) -> Result<Self, Box<dyn std::error::Error>> {
        let area = SVGBackend::new(path, size).into_drawing_area();
        area.fill(&WHITE)?;
        Ok(Self(area))
    }

    pub(super) fn line(&self, points: &[(f64, f64)], shade: (u8, u8, u8), width: u32) -> DrawResult {
        let style = colour(shade).stroke_width(width);
        Ok(self.0.draw(&PathElement::new(points.iter().map(|&p| pixels(p)).collect::<Vec<_>>(), style))?)
    }

    pub(super) fn block(
        &self,
        from: (f64, f64),
        to: (f64, f64),
        shade: (u8, u8, u8),
        opacity: f64,
    ) -> DrawResult {
        Ok(self.0.draw(&Rectangle::new([pixels(from), pixels(to)], colour(shade).mix(opacity).filled()))?)
    }

    pub(super) fn dot(&self, at: (f64, f64), shade: (u8, u8, u8), radius: i32) -> DrawResult {
        Ok(self.0.draw(&Circle::new(pixels(at), radius, colour(shade).filled()))?)
    }

    /// A word centered in height on its point.
    pub(super) fn text(
        &self,
        at: (f64, f64),
        words: &str,
        anchor: Anchor,
        look: (i32, (u8, u8, u8)),
    ) -> DrawResult {
        let horizontal = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Right => HPos::Right,
            Anchor::Middle => HPos::Center,
        };
        let shade = colour(look.1);
        let style = TextStyle::from(("sans-serif", look.0).into_font())
            .color(&shade)
            .pos(Pos::new(horizontal, VPos::Center));
        Ok(self.0.draw(&Text::new(words.to_string(), pixels(at), style))?)
    }

    /// Reads from below to above.
    pub(super) fn upright(&self, at: (f64, f64), words: &str, size: i32) -> DrawResult {
        let shade = colour(BLACK);
        let style = TextStyle::from(("sans-serif", size).into_font().transform(FontTransform::Rotate270))
            .color(&shade)
            .pos(Pos::new(HPos::Center, VPos::Center));
        Ok(self.0.draw(&Text::new(words.to_string(), pixels(at), style))?)
    }

    pub(super) fn finish(self) -> DrawResult {
        Ok(self.0.present()?)
    }
}
