//! A frame with axes, in which curves are drawn.

use std::fmt::Write;

use super::markup::{Element, classed, el};
use super::scale::Scale;
use crate::report::thinned;

/// Where a panel lies in its drawing, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

/// A frame with a horizontal and a vertical scale. Scales count pixels from the frame's corner.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Panel {
    frame: Frame,
    pub x: Scale,
    pub y: Scale,
    marks: Vec<Element>,
}

/// Values over values, with the name that a read-out gives them.
pub(super) struct Curve<'a> {
    /// Its looks, and what switches it on and off.
    pub class: &'a str,
    pub name: String,
    pub x: &'a [f64],
    pub y: &'a [f64],
    /// Points beyond which the curve is thinned.
    pub points: usize,
}

impl Panel {
    /// A panel with linear scales.
    pub fn new(frame: Frame, x: (f64, f64), y: (f64, f64)) -> Self {
        Panel {
            frame,
            x: Scale::linear(x, (0.0, frame.width)),
            y: Scale::linear(y, (frame.height, 0.0)),
            marks: Vec::new(),
        }
    }

    /// The panel with a logarithmic vertical scale.
    pub fn logarithmic(mut self, y: (f64, f64)) -> Self {
        self.y = Scale::decades(y, (self.frame.height, 0.0));
        self
    }

    /// Draws something in pixels from the frame's corner.
    pub fn mark(&mut self, mark: Element) {
        self.marks.push(mark);
    }

    /// Fills the band between two values over the whole width.
    pub fn band(&mut self, low: f64, high: f64) {
        let (top, bottom) = (self.y.at(high), self.y.at(low));
        self.mark(
            classed("rect", "band")
                .attr("x", 0)
                .attr("y", px(top))
                .attr("width", px(self.frame.width))
                .attr("height", px(bottom - top)),
        );
    }

    /// Draws a vertical line.
    pub fn upright(&mut self, value: f64, class: &str) {
        let x = px(self.x.at(value));
        self.mark(classed("path", class).attr("d", format!("M{x} 0V{}", px(self.frame.height))));
    }

    /// Draws a curve.
    pub fn curve(&mut self, curve: &Curve<'_>) {
        let mut d = String::new();
        for k in thinned(&[curve.y], curve.points.max(2)) {
            let (Some(x), Some(y)) = (curve.x.get(k), curve.y.get(k)) else {
                break;
            };
            let step = if d.is_empty() { 'M' } else { 'L' };
            let (x, y) = (self.x.beyond(*x), self.y.beyond(*y));
            // Writing to a String does not fail.
            let _ = write!(d, "{step}{} {}", px(x), px(y));
        }
        let path = classed("path", &format!("curve {}", curve.class));
        self.mark(path.attr("d", d).attr("data-name", &curve.name));
    }

    /// Draws a dot for each value within the frame.
    pub fn dots(&mut self, class: &str, x: &[f32], y: &[f32]) {
        let mut d = String::new();
        let pairs = x.iter().zip(y);
        let pairs = pairs.map(|(x, y)| (f64::from(*x), f64::from(*y)));
        for (x, y) in pairs.filter(|(x, y)| self.x.holds(*x) && self.y.holds(*y)) {
            // Writing to a String does not fail.
            let _ = write!(d, "M{} {}h0", px(self.x.at(x)), px(self.y.at(y)));
        }
        self.mark(classed("path", &format!("dots {class}")).attr("d", d));
    }

    /// Draws a bar from zero to each value.
    pub fn stems(&mut self, curve: &Curve<'_>) {
        let mut d = String::new();
        let zero = px(self.y.at(0.0));
        for (x, y) in curve.x.iter().zip(curve.y) {
            let _ = write!(d, "M{} {zero}V{}", px(self.x.at(*x)), px(self.y.at(*y)));
        }
        let path = classed("path", &format!("curve stems {}", curve.class));
        self.mark(path.attr("d", d).attr("data-name", &curve.name));
    }

    /// Grid, labels of the vertical axis and, with a title, of the horizontal one; then what was
    /// drawn, cut off at the frame. `unit` is that of the vertical values in a read-out.
    pub fn finish(self, x_title: Option<&str>, y_title: &str, unit: &str) -> Element {
        let Frame {
            left,
            top,
            width,
            height,
        } = self.frame;
        let (x0, x1) = self.x.range();
        let (y0, y1) = self.y.range();
        let kind = if self.y.is_logarithmic() {
            "log"
        } else {
            "linear"
        };
        let mut group = el("g").attr("transform", format!("translate({} {})", px(left), px(top)));
        group = group.children(self.grid(x_title));
        group = group.child(
            classed("text", "axis")
                .attr(
                    "transform",
                    format!("translate(-42 {}) rotate(-90)", px(height / 2.0)),
                )
                .attr("text-anchor", "middle")
                .text(y_title),
        );
        let area = classed("svg", "area")
            .attr("width", px(width))
            .attr("height", px(height))
            .attr(
                "data-frame",
                format!("{} {} {} {}", px(left), px(top), px(width), px(height)),
            )
            .attr("data-x", format!("{x0} {x1}"))
            .attr("data-y", format!("{y0} {y1} {kind}"))
            .attr("data-unit", unit);
        group.child(area.children(self.marks))
    }

    /// Grid lines and tick labels.
    fn grid(&self, x_title: Option<&str>) -> Vec<Element> {
        let Frame { width, height, .. } = self.frame;
        let mut grid = Vec::new();
        for tick in self.y.ticks(((height / 20.0) as usize).max(4)) {
            let y = px(self.y.at(tick.value));
            let class = if tick.value == 0.0 {
                "grid zero"
            } else {
                "grid"
            };
            grid.push(classed("path", class).attr("d", format!("M0 {y}H{}", px(width))));
            grid.push(label(-6.0, self.y.at(tick.value) + 3.5, "end", &tick.label));
        }
        for tick in self.x.ticks((width / 70.0) as usize) {
            let x = self.x.at(tick.value);
            grid.push(classed("path", "grid").attr("d", format!("M{} 0V{}", px(x), px(height))));
            if x_title.is_some() {
                grid.push(label(x, height + 13.0, "middle", &tick.label));
            }
        }
        let title = x_title
            .map(|title| label(width / 2.0, height + 27.0, "middle", title).attr("class", "axis"));
        grid.extend(title);
        grid
    }
}

/// A small text at a place.
pub(super) fn label(x: f64, y: f64, anchor: &str, text: &str) -> Element {
    el("text")
        .attr("x", px(x))
        .attr("y", px(y))
        .attr("text-anchor", anchor)
        .text(text)
}

/// A drawing of that size, with what it shows in words for those who cannot see it.
pub(super) fn drawing(class: &str, size: (f64, f64), words: &str) -> Element {
    classed("svg", class)
        .attr("viewBox", format!("0 0 {} {}", px(size.0), px(size.1)))
        .attr("role", "img")
        .attr("aria-label", words)
}

/// Pixels to a tenth, which is finer than any screen or printer shows.
pub(super) fn px(x: f64) -> f64 {
    // Adding zero turns -0 into 0.
    (x * 10.0).round() / 10.0 + 0.0
}
