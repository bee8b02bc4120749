//! Serde support for types of other crates, as the file of a part of a picture has them.
//!
//! `qrt-scene` serialises its types as YAML has them, which needs a format that describes itself. A
//! feature of `qrt-core` would make its `PixelClass` and `CallCost` serialise themselves, but the
//! macros use that crate without the feature, and it would be built twice.

use qrt_core::oracle::CallCost;
use qrt_counting::estimators::Noise;
use qrt_scene::{Accuracy, Estimator, Sequence};
use qrt_tracer::PixelClass;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(remote = "Accuracy")]
pub(crate) struct AccuracyFields {
    error: f64,
    confidence: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Noise")]
pub(crate) struct NoiseFields {
    depolarising: f64,
    readout: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "PixelClass")]
enum PixelClassNames {
    MayMeetLamp,
    MeetsNoLamp,
}

/// The proven bounds on a path's colour, by class of pixels.
pub(crate) mod bounds {
    use super::PixelClassNames;
    use qrt_tracer::{ByClass, PixelClass};
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Held {
        /// The lamps' outlines: see [`ByClass::outlines`].
        outlines: Option<Vec<Vec<[f64; 2]>>>,
        bounds: Vec<Bound>,
    }

    /// The bounds in the pixels of a class.
    #[derive(Serialize, Deserialize)]
    struct Bound {
        #[serde(with = "PixelClassNames")]
        class: PixelClass,
        bound: [f64; 3],
    }

    pub(crate) fn serialize<S: Serializer>(
        bounds: &ByClass<[f64; 3]>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let outlines = bounds.outlines();
        let bound = |&(class, bound): &(PixelClass, [f64; 3])| Bound { class, bound };
        let bounds = bounds.entries().iter().map(bound).collect();
        Held { outlines, bounds }.serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<ByClass<[f64; 3]>, D::Error> {
        let Held { outlines, bounds } = Held::deserialize(deserializer)?;
        let bounds = bounds.into_iter();
        let bounds = bounds.map(|Bound { class, bound }| (class, bound));
        let all = ByClass::of_parts(outlines, bounds.collect());
        all.ok_or_else(|| D::Error::custom("no bound of any class"))
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "CallCost")]
struct CallCostFields {
    qubits: u64,
    toffoli: u64,
}

/// The cost of a call, if there is a circuit.
pub(crate) mod call_cost {
    use super::{CallCost, CallCostFields};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Held(#[serde(with = "CallCostFields")] CallCost);

    #[allow(clippy::ref_option, reason = "serde calls it so")]
    pub(crate) fn serialize<S: Serializer>(
        cost: &Option<CallCost>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        cost.map(Held).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<CallCost>, D::Error> {
        let held = Option::<Held>::deserialize(deserializer)?;
        Ok(held.map(|Held(cost)| cost))
    }
}

/// A word of a scene.
pub(crate) trait Word: Copy {
    /// Returns the word's name in a scene.
    fn name(self) -> &'static str;

    /// Returns the word with a name; `None` if there is none.
    fn from_name(name: &str) -> Option<Self>;
}

impl Word for Estimator {
    fn name(self) -> &'static str {
        self.name()
    }

    fn from_name(name: &str) -> Option<Self> {
        Self::from_name(name)
    }
}

impl Word for Sequence {
    fn name(self) -> &'static str {
        self.name()
    }

    fn from_name(name: &str) -> Option<Self> {
        Self::from_name(name)
    }
}

/// Words of scenes, as their names.
pub(crate) mod word {
    use super::Word;
    use serde::de::Error as _;
    use serde::{Deserialize as _, Deserializer, Serializer};

    pub(crate) fn serialize<T: Word, S: Serializer>(
        word: &T,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(word.name())
    }

    pub(crate) fn deserialize<'de, T: Word, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<T, D::Error> {
        let name = <&str>::deserialize(deserializer)?;
        T::from_name(name).ok_or_else(|| D::Error::custom("no scene has this word"))
    }
}
