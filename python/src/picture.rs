//! Pictures: arrays that share their memory, files, and parts put together.

use crate::errors;
use crate::scene::Scene;
use numpy::ndarray::{ArrayView1, ArrayView3, ShapeError};
use numpy::{Element, PyArray1, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use qrt_runtime::image::{self, Encoding, ImageError};
use qrt_runtime::render::{Merge, Rendered};
use std::path::PathBuf;
use std::sync::OnceLock;

/// A picture with the facts of its render.
#[pyclass(frozen, module = "qrt")]
pub(crate) struct Picture {
    rendered: Rendered,
    scales: OnceLock<Vec<[f64; 3]>>,
    amplitudes: OnceLock<Vec<[f64; 3]>>,
}

/// Puts parts together; each has a name for errors and its bytes.
#[pyfunction]
pub(crate) fn merge(py: Python<'_>, parts: &Bound<'_, PyAny>) -> PyResult<Picture> {
    let mut merge = Merge::default();
    for part in parts.try_iter()? {
        let (name, bytes): (String, pyo3::pybacked::PyBackedBytes) = part?.extract()?;
        py.detach(|| merge.add(&name, &bytes))
            .map_err(|error| errors::merging(py, error))?;
    }
    let rendered = py.detach(|| merge.finish());
    let rendered = rendered.map_err(|error| errors::merging(py, error))?;
    Ok(Picture::new(rendered))
}

fn refused(py: Python<'_>, error: ImageError) -> PyErr {
    match error {
        ImageError::Io { source, path } => {
            pyo3::exceptions::PyOSError::new_err((source.raw_os_error(), source.to_string(), path))
        }
        error => errors::request(py, error),
    }
}

/// Returns a read-only array over memory of a picture, which the array keeps alive.
fn shared<'py, T: Element>(
    picture: &Bound<'py, Picture>,
    view: Result<ArrayView3<'_, T>, ShapeError>,
) -> PyResult<Bound<'py, PyArray3<T>>> {
    let view = view.map_err(|error| errors::job(picture.py(), error))?;
    // SAFETY: the memory belongs to the picture, which is frozen: it neither changes nor moves, and the
    // array holds a reference to the picture.
    let array = unsafe { PyArray3::borrow_from_array(&view, picture.clone().into_any()) };
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

impl Picture {
    pub(crate) fn new(rendered: Rendered) -> Self {
        Self {
            rendered,
            scales: OnceLock::new(),
            amplitudes: OnceLock::new(),
        }
    }

    /// Returns the bounds on a path's colour, by pixel.
    fn bounds(&self) -> &[[f64; 3]] {
        self.scales.get_or_init(|| {
            let [x, y, width, height] = self.rendered.crop;
            let rows = (y..y + height).flat_map(|y| (x..x + width).map(move |x| [x, y]));
            rows.map(|pixel| self.rendered.scales.at(pixel)).collect()
        })
    }

    /// Returns the estimates of S/N, by pixel; 0 where a channel is proven black.
    fn estimates(&self) -> &[[f64; 3]] {
        let of = |(pixel, scale): (&[f64; 3], &[f64; 3])| {
            std::array::from_fn(|c| {
                if scale[c] > 0.0 {
                    pixel[c] / scale[c]
                } else {
                    0.0
                }
            })
        };
        self.amplitudes.get_or_init(|| {
            let pixels = self.rendered.image.pixels.iter();
            pixels.zip(self.bounds()).map(of).collect()
        })
    }

    fn shape(&self) -> [usize; 2] {
        let [_, _, width, height] = self.rendered.crop;
        [height as usize, width as usize]
    }
}

#[pymethods]
impl Picture {
    /// Linear radiance: an array of (rows, columns, 3), float64, RGB, from the top left. It shares the
    /// picture's memory and can't be written to.
    #[getter]
    fn pixels<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let own = this.get();
        let [height, width] = own.shape();
        let flat = own.rendered.image.pixels.as_flattened();
        shared(this, ArrayView3::from_shape((height, width, 3), flat))
    }

    /// S, the good indices of each channel: an array of (rows, columns, 3), uint64, that shares the
    /// picture's memory. None of the model "real", which compares with no thresholds.
    #[getter]
    fn good<'py>(this: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray3<u64>>>> {
        let own = this.get();
        let [height, width] = own.shape();
        let Some(good) = own.rendered.good() else {
            return Ok(None);
        };
        let view = ArrayView3::from_shape((height, width, 3), good.as_flattened());
        shared(this, view).map(Some)
    }

    /// The width of the interval of a channel, in radiance: an array of (rows, columns, 3), float64; 0 under
    /// "exact". Of one run, that of the luminance stands in the first place.
    #[getter]
    fn widths<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let own = this.get();
        let [height, width] = own.shape();
        let flat = own.rendered.counted.widths.as_flattened();
        shared(this, ArrayView3::from_shape((height, width, 3), flat))
    }

    /// Strata of the comparator that were counted one by one: an array of (rows, columns, 3), uint8; 0
    /// where nothing is counted.
    #[getter]
    fn strata<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let own = this.get();
        let [height, width] = own.shape();
        let flat = own.rendered.counted.strata.as_flattened();
        shared(this, ArrayView3::from_shape((height, width, 3), flat))
    }

    /// Queries of the oracle: an array of (rows, columns), uint64, all channels together; 0 under "exact".
    #[getter]
    fn queries<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let own = this.get();
        let view = ArrayView1::from(own.rendered.counted.queries.as_slice());
        // SAFETY: as in `shared`.
        let array = unsafe { PyArray1::borrow_from_array(&view, this.clone().into_any()) };
        array.call_method1("setflags", (false,))?;
        array.call_method1("reshape", (own.shape(),))
    }

    /// The radiance of S = N, the proven bound on a path's colour: an array of (rows, columns, 3), float64,
    /// that can't be written to.
    #[getter]
    fn scales<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let own = this.get();
        let [height, width] = own.shape();
        let flat = own.bounds().as_flattened();
        shared(this, ArrayView3::from_shape((height, width, 3), flat))
    }

    /// Amplitudes S/N that were estimated: an array of (rows, columns, 3), float64, RGB, that can't be
    /// written to. Pixels over scales, and 0 where a channel is proven black.
    #[getter]
    fn amplitudes<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let own = this.get();
        let [height, width] = own.shape();
        let flat = own.estimates().as_flattened();
        shared(this, ArrayView3::from_shape((height, width, 3), flat))
    }

    /// N, the indices of a channel of a pixel: paths times thresholds.
    #[getter]
    fn total(&self) -> u64 {
        self.rendered.ids
    }

    /// Columns, in pixels.
    #[getter]
    fn width(&self) -> u32 {
        self.rendered.crop[2]
    }

    /// Rows, in pixels.
    #[getter]
    fn height(&self) -> u32 {
        self.rendered.crop[3]
    }

    /// x, y, width and height on the film, in pixels.
    #[getter]
    fn crop(&self) -> (u32, u32, u32, u32) {
        self.rendered.crop.into()
    }

    /// The key of its shifts and draws.
    #[getter]
    fn seed(&self) -> u64 {
        self.rendered.seed
    }

    /// The model that traced its paths.
    #[getter]
    fn model(&self) -> &'static str {
        self.rendered.model.name()
    }

    /// The estimator of its amplitudes.
    #[getter]
    fn estimator(&self) -> &'static str {
        self.rendered.estimator.name()
    }

    /// Wall time of tracing and counting, in seconds.
    #[getter]
    fn seconds(&self) -> f64 {
        self.rendered.seconds
    }

    /// Paths of all its pixels.
    #[getter]
    fn paths(&self) -> u64 {
        self.rendered.paths
    }

    /// The mean pixel: red, green, blue, in linear radiance.
    #[getter]
    fn mean(&self) -> (f64, f64, f64) {
        self.rendered.mean().into()
    }

    /// The facts of its render, as its files tell them.
    #[getter]
    fn metadata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let metadata = self
            .rendered
            .metadata()
            .map_err(|error| refused(py, error))?;
        let told = PyDict::new(py);
        for (key, value) in metadata.iter() {
            told.set_item(key, value)?;
        }
        Ok(told)
    }

    /// Write the picture to a file in .png (8-bit sRGB) or .exr (linear 32-bit float), all or nothing: the
    /// bytes of `qrt render -o`. `exposure` is in stops, for .png. Returns how many pixels were clipped.
    ///
    /// `layers` is the scene of the picture: an .exr then has, as of `qrt render --layers`, the layers
    /// interval.R .G .B (widths of intervals, in radiance), queries.Y, and of what the ray through a pixel's
    /// middle meets depth.Z (in units of the scene), normal.X .Y .Z and material.ID (from 1).
    ///
    /// Raises RequestError for another ending, for layers in .png or of another scene; OSError where the
    /// file can't be written.
    #[pyo3(signature = (path, *, exposure=None, layers=None))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        exposure: Option<f64>,
        layers: Option<Py<Scene>>,
    ) -> PyResult<u64> {
        let scene = layers.as_ref().map(Py::get);
        let layers = py.detach(|| match scene {
            Some(scene) => self.rendered.layers(scene.valid()),
            None => Ok(Vec::new()),
        });
        let layers = layers.map_err(|error| match scene {
            Some(scene) => scene.failure(py, error),
            None => errors::job(py, error),
        })?;
        let saved = py.detach(|| {
            let encoding = Encoding::for_path(&path, exposure)?;
            let mut metadata = self.rendered.metadata()?;
            if let Encoding::Png { exposure } = encoding {
                metadata.set("exposure", exposure.to_string())?;
            }
            image::save_layers(&path, &self.rendered.image, &layers, &metadata, encoding)
        });
        saved.map_err(|error| refused(py, error))
    }

    /// Write every channel of every pixel as CSV, x,y,channel,value,good,total,scale: the bytes of `qrt
    /// render --counts`.
    fn save_counts(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let saved = py.detach(|| image::write_counts(&path, self.rendered.counts()));
        saved.map_err(|error| refused(py, error))
    }

    fn __repr__(&self) -> String {
        let (width, height) = (self.width(), self.height());
        let (name, model) = (&self.rendered.scene_name, self.model());
        let estimator = self.estimator();
        format!("<qrt.Picture of {name:?}, {width} x {height} pixels, {model}, {estimator}>")
    }
}
