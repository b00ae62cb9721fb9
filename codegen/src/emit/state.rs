//! The state of a robot with the sines and cosines that all outputs share.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::naming;
use crate::expr::{AngleSum, Node, schedule};
use crate::robot::{Output, Robot};

/// Sines and cosines that any output needs.
fn trig(robot: &Robot) -> Vec<(usize, AngleSum, bool, bool)> {
    let values: Vec<_> = Output::ALL
        .into_iter()
        .flat_map(|output| robot.entries(output))
        .map(|entry| entry.value)
        .collect();
    let mut needed = schedule::order(&robot.graph, &values);
    needed.sort_unstable();
    let mut table: Vec<(usize, AngleSum, bool, bool)> = Vec::new();
    for node in needed {
        let (angle, sine) = match robot.graph.nodes()[node] {
            Node::Sin(angle) => (angle, true),
            Node::Cos(angle) => (angle, false),
            _ => continue,
        };
        let place = match table.iter().position(|&(known, ..)| known == angle) {
            Some(place) => place,
            None => {
                table.push((angle, robot.graph.angle(angle).clone(), false, false));
                table.len() - 1
            }
        };
        table[place].2 |= sine;
        table[place].3 |= !sine;
    }
    table
}

/// `State<T>` and its constructor.
pub fn state(robot: &Robot) -> TokenStream {
    let table = trig(robot);
    let mut fields = TokenStream::new();
    let mut bindings = TokenStream::new();
    let mut names = TokenStream::new();
    for (_, angle, sine, cosine) in &table {
        let [s, c] = ["s", "c"].map(|function| format_ident!("{}", naming::trig(function, angle)));
        let text = angle_text(angle);
        let sum = angle_tokens(angle);
        let (bind_s, bind_c) = match (sine, cosine) {
            (true, true) => (quote! { #s }, quote! { #c }),
            (true, false) => (quote! { #s }, quote! { _ }),
            _ => (quote! { _ }, quote! { #c }),
        };
        let sum = match angle.terms.len() == 1 && angle.offset.is_zero() {
            true => sum,
            false => quote! { (#sum) },
        };
        bindings.extend(quote! { let (#bind_s, #bind_c) = #sum.sin_cos(); });
        for (wanted, name, function) in [(sine, &s, "sin"), (cosine, &c, "cos")] {
            if *wanted {
                let doc = format!(" {function}({text})");
                fields.extend(quote! { #[doc = #doc] pub #name: T, });
                names.extend(quote! { #name, });
            }
        }
    }
    let [slip_field, slip_value, with_slip] = slip(robot);
    quote! {
        #[doc = " A state of the robot, with the sines and cosines that all outputs share."]
        #[derive(Clone, Copy, Debug)]
        pub struct State<T> {
            #[doc = " Joint positions, rad or m."]
            pub q: [T; JOINTS],
            #[doc = " Joint velocities, rad/s or m/s."]
            pub qd: [T; JOINTS],
            #[doc = " Joint accelerations, rad/s^2 or m/s^2."]
            pub qdd: [T; JOINTS],
            #slip_field
            #fields
        }

        impl<T: Lane> State<T> {
            #[doc = " Computes each sine and cosine once."]
            #[inline]
            pub fn new(q: [T; JOINTS], qd: [T; JOINTS], qdd: [T; JOINTS]) -> Self {
                #bindings
                State { q, qd, qdd, #slip_value #names }
            }
            #with_slip
        }
    }
}

/// The presliding states as a field, as the constructor sets them, and how a caller does; empty
/// for a robot whose friction has no memory.
fn slip(robot: &Robot) -> [TokenStream; 3] {
    if robot.mechanism.presliding().next().is_none() {
        return Default::default();
    }
    [
        quote! {
            #[doc = " Presliding states z/zs; the signs of the velocities in sliding."]
            pub slip: [T; JOINTS],
        },
        quote! { slip: qd.map(Lane::sign), },
        quote! {
            #[doc = " With presliding states, dz/dt = qd - |qd| z/zs, instead of those of sliding."]
            #[inline]
            pub fn with_slip(self, slip: [T; JOINTS]) -> Self {
                State { slip, ..self }
            }
        },
    ]
}

fn angle_text(angle: &AngleSum) -> String {
    let mut text = String::new();
    for &(joint, sign) in &angle.terms {
        let sign = match (text.is_empty(), sign < 0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text.push_str(&format!("{sign}q{}", joint + 1));
    }
    if !angle.offset.is_zero() {
        text.push_str(&format!(" + {}", angle.offset.text()));
    }
    text
}

fn angle_tokens(angle: &AngleSum) -> TokenStream {
    let mut sum = TokenStream::new();
    for (place, &(joint, sign)) in angle.terms.iter().enumerate() {
        let joint = Literal::usize_unsuffixed(joint);
        sum.extend(match (place, sign < 0) {
            (0, false) => quote! { q[#joint] },
            (0, true) => quote! { -q[#joint] },
            (_, false) => quote! { + q[#joint] },
            (_, true) => quote! { - q[#joint] },
        });
    }
    if !angle.offset.is_zero() {
        let value = angle.offset.value();
        let size = Literal::f64_unsuffixed(value.abs());
        sum.extend(match value < 0.0 {
            true => quote! { - T::splat(#size) },
            false => quote! { + T::splat(#size) },
        });
    }
    sum
}
