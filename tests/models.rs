//! Identities between the models of every built-in robot, and between the generated code and the
//! interpreter.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::ops::{Add, Mul, Neg, Sub};

use idim::codegen::builder;
use idim::interpreted::Interpreter;
use idim::robots;
use idim::runtime::lane::{Lane, Product};
use idim::runtime::model::{Entry, IdentificationModel, Output, States};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

/// A number with its derivative in time: run through the generated code it differentiates the
/// code itself, without the error of finite differences.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dual {
    value: f64,
    rate: f64,
}

impl Dual {
    const ZERO: Dual = Dual {
        value: 0.0,
        rate: 0.0,
    };
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual {
            value: self.value + other.value,
            rate: self.rate + other.rate,
        }
    }
}
impl Sub for Dual {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        Dual {
            value: self.value - other.value,
            rate: self.rate - other.rate,
        }
    }
}
impl Mul for Dual {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        let rate = self.rate * other.value + self.value * other.rate;
        Dual {
            value: self.value * other.value,
            rate,
        }
    }
}
impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual {
            value: -self.value,
            rate: -self.rate,
        }
    }
}
impl Add<Product<Dual>> for Dual {
    type Output = Dual;
    fn add(self, product: Product<Dual>) -> Dual {
        product + self
    }
}
impl Sub<Product<Dual>> for Dual {
    type Output = Dual;
    fn sub(self, product: Product<Dual>) -> Dual {
        -(product - self)
    }
}
impl Lane for Dual {
    fn splat(self, value: f64) -> Dual {
        Dual { value, rate: 0.0 }
    }
    fn sin_cos(self) -> (Dual, Dual) {
        let (s, c) = self.value.sin_cos();
        (
            Dual {
                value: s,
                rate: c * self.rate,
            },
            Dual {
                value: c,
                rate: -s * self.rate,
            },
        )
    }
    fn sign(self) -> Dual {
        self.splat(Lane::sign(self.value))
    }
    fn abs(self) -> Dual {
        Dual {
            value: self.value.abs(),
            rate: Lane::sign(self.value) * self.rate,
        }
    }
    fn tanh(self) -> Dual {
        let value = self.value.tanh();
        Dual {
            value,
            rate: (1.0 - value * value) * self.rate,
        }
    }
    fn bell(self) -> Dual {
        let value = (-self.value * self.value).exp();
        Dual {
            value,
            rate: -2.0 * self.value * value * self.rate,
        }
    }
    fn abs_power(self, p: f64) -> Dual {
        let slope = p * self.value.abs().powf(p - 1.0) * Lane::sign(self.value);
        Dual {
            value: self.value.abs().powf(p),
            rate: slope * self.rate,
        }
    }
    fn reciprocal(self) -> Dual {
        let value = self.value.recip();
        Dual {
            value,
            rate: -value * value * self.rate,
        }
    }
    fn root(self) -> Dual {
        let value = self.value.sqrt();
        Dual {
            value,
            rate: 0.5 * self.rate / value,
        }
    }
}

const STATES: usize = 200;

/// Uniform in [-size, size).
fn uniform(generator: &mut Pcg64Mcg, size: f64) -> f64 {
    size * ((generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
}

fn arrays<const N: usize>(generator: &mut Pcg64Mcg) -> [[f64; N]; 3] {
    [3.1, 2.5, 8.0].map(|size| std::array::from_fn(|_| uniform(generator, size)))
}

/// Rounding of sums of terms of this size.
fn close(a: f64, b: f64, size: f64) -> bool {
    (a - b).abs() <= 1e-12 * size.max(1.0)
}

macro_rules! identities {
    ($($robot:ident),*) => {$(
        mod $robot {
            use super::*;
            use robots::$robot::*;

            type Matrix<T> = [[T; PARAMETERS]; JOINTS];

            #[test]
            fn explicit_model_is_the_derivative_of_the_momentum_plus_the_rest() {
                let mut generator = Pcg64Mcg::new(1);
                for _ in 0..STATES {
                    let [q, qd, qdd] = arrays::<JOINTS>(&mut generator);
                    let d = explicit_at(q, qd, qdd);
                    let (p, r) = implicit_along(q, qd, qdd);
                    for joint in 0..JOINTS {
                        for column in 0..PARAMETERS {
                            let rate = p[joint][column].rate;
                            let rest = r[joint][column].value;
                            assert!(
                                close(d[joint][column], rate + rest, rate.abs().max(rest.abs())),
                                "{}, joint {}", COLUMNS[column].name, joint + 1
                            );
                        }
                    }
                }
            }

            #[test]
            fn power_is_the_derivative_of_the_energy_plus_what_friction_takes() {
                let mut generator = Pcg64Mcg::new(2);
                for _ in 0..STATES {
                    let [q, qd, qdd] = arrays::<JOINTS>(&mut generator);
                    let d = explicit_at(q, qd, qdd);
                    let along = State::new(duals(q, qd), duals(qd, qdd), duals(qdd, [0.0; JOINTS]));
                    let mut h = [Dual::ZERO; PARAMETERS];
                    let mut dh = [Dual::ZERO; PARAMETERS];
                    energy(&along, &mut h);
                    power(&along, &mut dh);
                    for column in 0..PARAMETERS {
                        let terms: [f64; JOINTS] =
                            std::array::from_fn(|joint| qd[joint] * d[joint][column]);
                        let size = terms.iter().map(|term| term.abs()).sum();
                        let sum: f64 = terms.iter().sum();
                        assert!(
                            close(sum, h[column].rate + dh[column].value, size),
                            "{}: {sum}", COLUMNS[column].name
                        );
                    }
                }
            }

            #[test]
            fn interpreter_equals_the_generated_code() {
                let texts = robots::ALL.iter().find(|robot| robot.name == NAME).unwrap().texts;
                let interpreter = Interpreter::new(&builder::read_texts(texts).unwrap());
                assert_same(&Model, &interpreter);
            }

            fn explicit_at(
                q: [f64; JOINTS],
                qd: [f64; JOINTS],
                qdd: [f64; JOINTS],
            ) -> Matrix<f64> {
                let mut d = [[0.0; PARAMETERS]; JOINTS];
                explicit(&State::new(q, qd, qdd), &mut d);
                d
            }

            fn implicit_along(
                q: [f64; JOINTS],
                qd: [f64; JOINTS],
                qdd: [f64; JOINTS],
            ) -> (Matrix<Dual>, Matrix<Dual>) {
                let zero = [[Dual::ZERO; PARAMETERS]; JOINTS];
                let (mut p, mut r) = (zero, zero);
                let x = State::new(duals(q, qd), duals(qd, qdd), duals(qdd, [0.0; JOINTS]));
                implicit(&x, &mut p, &mut r);
                (p, r)
            }

            fn duals(values: [f64; JOINTS], rates: [f64; JOINTS]) -> [Dual; JOINTS] {
                std::array::from_fn(|joint| Dual { value: values[joint], rate: rates[joint] })
            }
        }
    )*};
}

identities!(scara, emps, tx40, ur10e, panda, puma560, rx90);

#[test]
fn identities_cover_every_built_in_robot() {
    let names: Vec<&str> = robots::ALL.iter().map(|robot| robot.name).collect();
    assert_eq!(
        names,
        ["emps", "panda", "puma560", "rx90", "scara", "tx40", "ur10e"]
    );
}

/// Same joints, columns, settings, patterns, and the same signals to the bit on random states:
/// both are readers of one graph and group every operation alike.
fn assert_same(a: &dyn IdentificationModel, b: &dyn IdentificationModel) {
    assert_eq!(a.knowledge(), b.knowledge());
    assert_eq!(a.name(), b.name());
    assert_eq!(a.joints(), b.joints());
    assert_eq!(a.columns(), b.columns());
    assert_eq!(a.settings(), b.settings());
    let n = a.joints().len();
    let len = 203;
    let mut generator = Pcg64Mcg::new(3);
    let mut series = |size| -> Vec<f64> {
        (0..n * len)
            .map(|_| uniform(&mut generator, size))
            .collect()
    };
    let (q, qd, qdd, slip) = (series(3.1), series(2.5), series(8.0), series(1.0));
    let sliding = States {
        len,
        q: &q,
        qd: &qd,
        qdd: &qdd,
        slip: &[],
    };
    let states = States {
        slip: &slip,
        ..sliding
    };
    assert_eq!(a.presliding(), b.presliding());
    for (output, states) in Output::ALL
        .into_iter()
        .flat_map(|o| [(o, states), (o, sliding)])
    {
        assert_eq!(a.pattern(output), b.pattern(output));
        let count = a.pattern(output).signals * len;
        let (mut first, mut second) = (vec![f64::NAN; count], vec![f64::NAN; count]);
        a.evaluate(output, &states, &mut first);
        b.evaluate(output, &states, &mut second);
        for (place, (x, y)) in first.iter().zip(&second).enumerate() {
            assert_eq!(x, y, "{output:?}, signal {}", place / len);
        }
    }
}

#[test]
fn columns_in_another_order_carry_their_names_along() {
    let text = |effects: &str| {
        format!(
            "name = \"arm\"\neffects = [{effects}]\n[[joint]]\nname = \"a\"\nkind = \"revolute\"\n\
             [[joint]]\nname = \"b\"\nkind = \"revolute\"\nalpha = \"pi/2\"\nd = 0.3\n"
        )
    };
    let model = |effects: &str| {
        let robot = builder::read_texts(&[("arm.toml", &text(effects))]).unwrap();
        Interpreter::new(&robot)
    };
    let one = model("\"viscous\", \"coulomb\", \"offset\"");
    let other = model("\"offset\", \"viscous\", \"coulomb\"");
    let names = |model: &Interpreter| -> Vec<String> {
        model
            .columns()
            .iter()
            .map(|column| column.name.to_string())
            .collect()
    };
    assert_ne!(names(&one), names(&other));
    let (q, qd, qdd) = ([0.3, -0.7], [1.1, -0.4], [0.2, 2.0]);
    for output in Output::ALL {
        let values = |model: &Interpreter| {
            let mut signals = vec![0.0; model.pattern(output).signals];
            let states = States {
                len: 1,
                q: &q,
                qd: &qd,
                qdd: &qdd,
                slip: &[],
            };
            model.evaluate(output, &states, &mut signals);
            let entries = model.pattern(output).entries.iter();
            let mut named: Vec<(String, usize, f64)> = entries
                .map(|entry| {
                    let name = model.columns()[entry.column].name.to_string();
                    (name, entry.row, signals[entry.signal])
                })
                .collect();
            named.sort_by(|a, b| (&a.0, a.1).cmp(&(&b.0, b.1)));
            named
        };
        assert_eq!(values(&one), values(&other), "{output:?}");
    }
}

#[test]
fn effects_are_the_torques_of_their_formulas() {
    let effects = [
        ("viscous_asymmetry", ""),
        ("stribeck", "velocity = 0.4"),
        ("nonlinear_viscous", "p = 1.5"),
        ("position_dependent_friction", "N = 3"),
        ("torque_ripple", "N = 2.5"),
        ("spring", ""),
        ("presliding", "zs = 0.01"),
    ];
    let mut text = "name = \"arm\"\neffects = [\"coulomb\"]\n[[joint]]\nname = \"a\"\n\
                    kind = \"revolute\"\n"
        .to_owned();
    for (kind, shape) in effects {
        text.push_str(&format!(
            "[[effect]]\nkind = \"{kind}\"\njoint = \"a\"\n{shape}\n"
        ));
    }
    let model = Interpreter::new(&builder::read_texts(&[("arm.toml", &text)]).unwrap());
    for (q, qd, slip) in [(0.7f64, -0.3f64, 0.2f64), (-1.9, 0.9, 1.0)] {
        let torque = |name: &str, output: Output| {
            let mut signals = vec![f64::NAN; model.pattern(output).signals];
            let states = States {
                len: 1,
                q: &[q],
                qd: &[qd],
                qdd: &[0.0],
                slip: &[slip],
            };
            model.evaluate(output, &states, &mut signals);
            let named = |entry: &&Entry| model.columns()[entry.column].name == name;
            let entry = model.pattern(output).entries.iter().find(named).unwrap();
            signals[entry.signal]
        };
        let direction = qd.signum();
        for (name, expected) in [
            ("FVA1", qd.abs()),
            ("FST1", direction * (-(qd / 0.4).powi(2)).exp()),
            ("FVN1", direction * qd.abs().powf(1.5)),
            ("FPS1", (3.0 * q).sin() * direction),
            ("FPC1", (3.0 * q).cos() * direction),
            ("RS1", (2.5 * q).sin()),
            ("RC1", (2.5 * q).cos()),
            ("K1", q),
            ("FP1", slip - direction),
        ] {
            for (output, value) in [
                (Output::Explicit, expected),
                (Output::Rest, expected),
                (Output::Power, qd * expected),
            ] {
                let found = torque(name, output);
                assert!(
                    (found - value).abs() < 4.0 * f64::EPSILON,
                    "{name}: {found} {value}"
                );
            }
        }
    }
}
