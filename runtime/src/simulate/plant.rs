//! A robot with its drives and encoders: what a controller commands and sees.

use super::influence::Influence;
use crate::model::IdentificationModel;

/// A drive, from the commanded torque to the one at the joint: gain, then dead zone, saturation,
/// lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Torque delivered per torque commanded.
    pub gain: f64,
    /// Torque that is lost in either direction, N m or N; below it nothing is delivered.
    pub dead_zone: f64,
    /// Level, N m or N, and the share of what is commanded beyond it that is delivered.
    pub saturation: Option<(f64, f64)>,
    /// Time constant of a first-order lag, s; 0: none.
    pub lag: f64,
}

impl Drive {
    /// The drive that does what it is told.
    pub const IDEAL: Drive = Drive {
        gain: 1.0,
        dead_zone: 0.0,
        saturation: None,
        lag: 0.0,
    };

    /// The torque that a constant command comes to, N m or N.
    pub fn delivers(&self, command: f64) -> f64 {
        let torque = self.gain * command;
        let left = (torque.abs() - self.dead_zone.max(0.0)).max(0.0);
        let size = match self.saturation {
            Some((level, share)) if left > level => level + share * (left - level),
            _ => left,
        };
        size.copysign(torque)
    }
}

/// An encoder, from the position of its joint to what it reads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoder {
    /// Error along the turn, \\( s \sin N q + c \cos N q \\): N, s, c (rad).
    pub eccentricity: Option<(f64, f64, f64)>,
    /// Resolution, rad or m; `None`: exact.
    pub resolution: Option<f64>,
}

impl Encoder {
    /// What it reads at a position, rad or m.
    pub fn reads(&self, q: f64) -> f64 {
        let seen = match self.eccentricity {
            Some((times, sine, cosine)) => {
                let (sin, cos) = (times * q).sin_cos();
                q + sine * sin + cosine * cos
            }
            None => q,
        };
        let rounded = |step: f64| (seen / step).round() * step;
        self.resolution.map_or(seen, rounded)
    }
}

/// A robot as a controller meets it. Its model may have more joints than the controller knows:
/// those without a drive follow (the link behind a gear that yields, a base that rocks).
pub struct Plant<'a> {
    /// The robot.
    pub model: &'a dyn IdentificationModel,
    /// Its np parameters.
    pub parameters: &'a [f64],
    /// The joints with a drive and an encoder, from 0, in the order of the controller's.
    pub driven: Vec<usize>,
    /// Their drives.
    pub drives: Vec<Drive>,
    /// Their encoders.
    pub encoders: Vec<Encoder>,
    /// What else acts.
    pub influences: Vec<Box<dyn Influence + 'a>>,
}

impl<'a> Plant<'a> {
    /// A robot with ideal drives and encoders on every joint, and nothing else.
    pub fn ideal(model: &'a dyn IdentificationModel, parameters: &'a [f64]) -> Plant<'a> {
        let joints = model.joints().len();
        Plant {
            model,
            parameters,
            driven: (0..joints).collect(),
            drives: vec![Drive::IDEAL; joints],
            encoders: vec![Encoder::default(); joints],
            influences: Vec::new(),
        }
    }
}

/// The drives at work, each with the torque that its lag has reached.
pub(super) struct Driving<'p> {
    drives: Vec<Drive>,
    driven: &'p [usize],
    /// Torques at the last command, and where they tend to since.
    reached: Vec<f64>,
    aims: Vec<f64>,
    /// Time of the last command, s; none yet.
    since: Option<f64>,
}

impl<'p> Driving<'p> {
    pub(super) fn new(plant: &'p Plant<'_>) -> Driving<'p> {
        Driving {
            drives: plant.drives.clone(),
            driven: &plant.driven,
            reached: vec![0.0; plant.driven.len()],
            aims: vec![0.0; plant.driven.len()],
            since: None,
        }
    }

    /// A new command from a time on, s; the first one is reached at once.
    pub(super) fn command(&mut self, t: f64, command: &[f64]) {
        for (place, command) in command.iter().enumerate() {
            let aim = self.drives[place].delivers(*command);
            self.reached[place] = match self.since {
                Some(_) => self.torque(place, t),
                None => aim,
            };
            self.aims[place] = aim;
        }
        self.since = Some(t);
    }

    /// The torque of a drive at a time.
    fn torque(&self, place: usize, t: f64) -> f64 {
        let (lag, aim) = (self.drives[place].lag, self.aims[place]);
        match self.since {
            Some(since) if lag > 0.0 => {
                aim + (self.reached[place] - aim) * (-(t - since) / lag).exp()
            }
            _ => aim,
        }
    }

    /// The torques at a time at the joints of the model, zero at those without a drive.
    pub(super) fn at(&self, t: f64, tau: &mut [f64]) {
        tau.fill(0.0);
        for (place, &joint) in self.driven.iter().enumerate() {
            tau[joint] = self.torque(place, t);
        }
    }
}
