//! The drawing kit of qrt: it draws the figures of `qrt inspect`, of `qrt trade` and of the book.
//!
//! A [`Canvas`] collects a drawing's elements and becomes an SVG. The SVG is self-contained, has no
//! scripts and follows its reader's colour scheme. A [`Panel`] is a part of a drawing with linear
//! axes. A [`Plot`] is a whole drawing with logarithmic axes. All colours come from one palette
//! ([`coloured`]), in which each name has one meaning.
//!
//! ```
//! use qrt_drawing::Canvas;
//! let mut canvas = Canvas::new("One wire", 200.0, 60.0);
//! canvas.line("wire", [10.0, 40.0], [190.0, 40.0]);
//! canvas.text("soft end", [190.0, 34.0], "ray_0 & colour");
//! let svg = canvas.svg();
//! assert!(svg.contains("<path class=\"wire\" d=\"M10 40L190 40\"/>"));
//! assert!(svg.contains("ray_0 &amp; colour"));
//! ```

#![forbid(unsafe_code)]

mod canvas;
mod escape;
mod palette;
mod panel;
mod plot;

pub use canvas::{Canvas, SMALL, number, polyline, text_width};
pub use escape::escaped;
pub use palette::{STYLES, coloured, style_sheet};
pub use panel::{Panel, minus, ticks};
pub use plot::{Drawn, Fit, Plot, PlotAxis, Point, Scale, Series};
