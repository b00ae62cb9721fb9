//! Why a robot cannot be simulated.

/// Why a forward dynamics or a simulation is not possible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulateError {
    /// A wrong number of parameters.
    #[error("{has} parameters were given and the robot {robot} has {needs}")]
    Parameters {
        /// The robot.
        robot: String,
        /// Parameters given.
        has: usize,
        /// Parameters of the model.
        needs: usize,
    },
    /// Parameters without a value.
    #[error("no value is given for {} of {robot}", names.join(", "))]
    Missing {
        /// The robot.
        robot: String,
        /// Names of the parameters.
        names: Vec<String>,
    },
    /// A parameter that is NaN or infinite.
    #[error("the parameter {name} is {value}: it must be a finite number")]
    NotFinite {
        /// The parameter.
        name: String,
        /// Its value.
        value: f64,
    },
    /// The parameters give a mass matrix that no robot can have.
    #[error(
        "the mass matrix is not positive definite at joint {joint} (pivot {pivot:.3e}, q = \
         {q:.3?}): the parameters are not those of a physical robot there"
    )]
    NotPositiveDefinite {
        /// Name of the joint at whose pivot the Cholesky factorisation broke down.
        joint: String,
        /// The pivot, kg m^2 or kg.
        pivot: f64,
        /// Joint positions, rad or m.
        q: Vec<f64>,
    },
    /// Reference, controller, torque or start of another robot.
    #[error("the {what} is for {has} joints, the robot {robot} has {needs}")]
    Joints {
        /// Reference, controller, ...
        what: &'static str,
        /// Joints that it has.
        has: usize,
        /// The robot.
        robot: String,
        /// Joints of the robot.
        needs: usize,
    },
    /// Series of unequal or wrong length.
    #[error("the {what} of joint {joint} has {has} samples, expected {needs}")]
    Length {
        /// Reference, torque, ...
        what: &'static str,
        /// Joint, counted from 1.
        joint: usize,
        /// Samples found.
        has: usize,
        /// Samples expected.
        needs: usize,
    },
    /// A sampling rate, step or tolerance that is not a positive number.
    #[error("{what} = {value}: it must be finite and greater than zero")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A log without samples.
    #[error("there is nothing to simulate: no sample")]
    Empty,
    /// A log with neither reference and controller nor torque.
    #[error("{log} has no reference with a controller, and no torque: nothing drives the robot")]
    Undriven {
        /// Name of the recording.
        log: String,
    },
    /// A motion that left its reference, or every bound.
    #[error(
        "the simulation diverges: joint {joint} leaves {what} at {second:.3} s. Check the \
         parameters, and whether reference and controller are those of this robot"
    )]
    Diverged {
        /// Name of the first joint that left.
        joint: String,
        /// What it left: `its reference` or `every bound`.
        what: &'static str,
        /// First time at which it was found outside, s.
        second: f64,
    },
    /// The variable-step method cannot meet its tolerance, or a fixed step is absurd.
    #[error("the step fell below 1e-12 s at {second:.6} s: ask for less accuracy or a longer step")]
    StepTooSmall {
        /// Time, s.
        second: f64,
    },
}
