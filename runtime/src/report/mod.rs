//! Results as one serialisable value, and its renderings.
//!
//! [`Identification`] is all that is said about an identification: its JSON is the machine
//! readable report, and [`terminal()`] and [`html()`] render nothing but this value.

pub(crate) mod changed;
mod diagnosed;
mod diagnosis;
mod excitation;
mod gains;
mod html;
mod identification;
mod instrumented;
mod payload;
mod pictures;
mod prior;
mod series;
mod smooth;
mod table;
mod terminal;
mod thin;

pub use changed::{AtTool, Changed, Contact, FrictionChange, OtherChange, TorqueScale, Touched};
pub use diagnosed::{diagnosed, parameter, place};
pub use diagnosis::{
    Alternative, Change, Diagnosis, EffectParameter, Estimated, FoundEffect, Gap, Located,
    RankedEffect, Refitted, RejectedEffect, Rms, Verdict,
};
pub use excitation::terminal as excitation_terminal;
pub use gains::{DriveGains, GainFactor, terminal as gains_terminal};
pub use html::{diagnosis_html, html, story};
pub use identification::{
    Disagreement, Fit, Identification, InstrumentedFit, InstrumentedValue, JointFit, ModelResult,
    ParameterResult, PriorValue, Truth, Validation, WithPrior,
};
pub use payload::{LoadParameter, Payload, Physical, terminal as payload_terminal};
pub use pictures::{GapCurves, Pictures, Signature};
pub use series::{JointSeries, LogSeries, ModelSeries, Role, Spectrum};
pub(crate) use smooth::hats;
pub use smooth::{Smooth, SmoothVariable};
pub use terminal::terminal;
pub(crate) use thin::thinned;
