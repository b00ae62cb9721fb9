//! Three joints that turn in a ring whose other joints are known: two links between two known
//! points, solved by the law of cosines.

use super::plane::{Algebra, Complex, Displacement};
use super::ring::{Element, Moves, Ring};

/// The three unknown joints of a ring.
#[derive(Clone, Debug, PartialEq)]
pub struct Dyad {
    /// Begins with the first unknown joint.
    ring: Ring,
    /// Places of the unknown joints.
    unknown: [usize; 3],
    /// 1 or -1: on which side of the line between the points the middle joint lies.
    side: f64,
    /// Driven joints that they move with, ascending.
    pub drivers: Vec<usize>,
}

impl Dyad {
    /// The unknown joints of a ring, by their places in it: those that turn, three.
    pub fn new(ring: Ring, is_unknown: impl Fn(&Element) -> bool, side: f64) -> Option<Dyad> {
        let mut best: Option<(usize, Ring, [usize; 3])> = None;
        let mut ring = ring;
        for _ in 0..ring.elements.len() {
            let places: Vec<usize> = (0..ring.elements.len())
                .filter(|&place| is_unknown(&ring.elements[place]))
                .collect();
            let [first, second, third] = places[..] else {
                return None;
            };
            // Known joints between the unknown ones make the lengths of the links vary.
            let between = third - first - 2;
            if first == 0 && best.as_ref().is_none_or(|(least, ..)| between < *least) {
                best = Some((between, ring.clone(), [first, second, third]));
            }
            ring = ring.shifted();
        }
        let (_, ring, unknown) = best?;
        let turns = unknown
            .iter()
            .all(|&place| matches!(ring.elements[place].motion, Moves::Turns(_)));
        turns.then_some(Dyad {
            ring,
            unknown,
            side,
            drivers: vec![],
        })
    }

    /// The same loop assembled on a side, 1 or -1.
    pub fn on_side(&self, side: f64) -> Dyad {
        Dyad {
            side,
            ..self.clone()
        }
    }

    /// The unknown joints, `None` for one that is cut.
    pub fn joints(&self) -> [Option<usize>; 3] {
        self.unknown.map(|place| self.ring.elements[place].joint)
    }

    /// The known joints of the ring.
    pub fn known(&self) -> impl Iterator<Item = usize> + '_ {
        let places = (0..self.ring.elements.len()).filter(|place| !self.unknown.contains(place));
        places.filter_map(|place| self.ring.elements[place].joint)
    }

    /// The same with other numbers for the joints; one that becomes two turns as their sum.
    pub fn renumbered(&self, numbers: impl Fn(usize) -> Vec<usize>) -> Dyad {
        let mut renumbered = self.clone();
        renumbered.ring.elements.clear();
        for (place, element) in self.ring.elements.iter().enumerate() {
            if let Some(index) = self.unknown.iter().position(|&unknown| unknown == place) {
                renumbered.unknown[index] = renumbered.ring.elements.len();
            }
            let joints = match element.joint {
                Some(joint) => numbers(joint).into_iter().map(Some).collect(),
                None => vec![None],
            };
            let copies = joints
                .into_iter()
                .map(|joint| Element { joint, ..*element });
            renumbered.ring.elements.extend(copies);
        }
        renumbered.drivers = self.drivers.iter().flat_map(|&at| numbers(at)).collect();
        renumbered.drivers.sort_unstable();
        renumbered
    }

    /// Cosines and sines of the positions of the unknown joints; NaN where the ring cannot close.
    ///
    /// With the first joint at A, the second at B, the third at C before they turn, v1 = B - A,
    /// v2 = C - B, and w from A to where C has to go: the turn of the second follows from |w|, that
    /// of the first from the direction of w, and the third's from their sum.
    pub fn turns<A: Algebra>(&self, a: &mut A) -> [Complex<A::Value>; 3] {
        let [v1, v2, w] = self.links(a);
        let [alpha, beta] = self.two(v1, v2, w, a);
        let known = self.product(0..self.ring.elements.len(), a).turn;
        let target = self.ring.target.turn.constant(a);
        let sum = target.times(known.conjugate(a), a);
        let both = alpha.times(beta, a).conjugate(a);
        let turns = [alpha, beta, sum.times(both, a)];
        [0, 1, 2].map(|index| Complex {
            im: a.scale(self.sign(index), turns[index].im),
            ..turns[index]
        })
    }

    /// The sine of the angle between the two links; NaN where the ring cannot close.
    pub fn bend<A: Algebra<Value = f64>>(&self, a: &mut A) -> f64 {
        let [v1, v2, _] = self.links(a);
        let [_, beta, _] = self.turns(a);
        let second = v2.times(
            Complex {
                im: self.sign(1) * beta.im,
                ..beta
            },
            a,
        );
        let across = v1.re * second.im - v1.im * second.re;
        across / (v1.square(a) * v2.square(a)).sqrt()
    }

    fn sign(&self, index: usize) -> f64 {
        self.ring.elements[self.unknown[index]].sign
    }

    /// v1, v2 and w.
    fn links<A: Algebra>(&self, a: &mut A) -> [Complex<A::Value>; 3] {
        let [first, second, third] = self.unknown;
        let elements = &self.ring.elements;
        let before_second = self.product(first + 1..second, a);
        let to_third = self.product(second + 1..third, a);
        let after = self.product(third + 1..elements.len(), a);
        let before_third = before_second.times(&to_third, a);
        let [from, middle, to] = self.unknown.map(|place| elements[place].point());
        let (from, middle, to) = (from.constant(a), middle.constant(a), to.constant(a));
        let middle = before_second.of(middle, a);
        let v1 = middle.minus(from, a);
        let v2 = before_third.of(to, a).minus(middle, a);
        let back = after.inverse(a).of(to, a);
        let target = self.ring.target.constant(a);
        let w = target.of(back, a).minus(from, a);
        [v1, v2, w]
    }

    /// The turns of the first two joints.
    fn two<A: Algebra>(
        &self,
        v1: Complex<A::Value>,
        v2: Complex<A::Value>,
        w: Complex<A::Value>,
        a: &mut A,
    ) -> [Complex<A::Value>; 2] {
        let (first, second, far) = (v1.square(a), v2.square(a), w.square(a));
        let sum = a.add(first, second);
        let difference = a.sub(far, sum);
        // |v1| |v2| times cosine and sine of the angle between the links.
        let re = a.scale(0.5, difference);
        let (product, square) = (a.mul(first, second), a.mul(re, re));
        let rest = a.sub(product, square);
        let root = a.root(rest);
        let im = a.scale(self.side, root);
        let over = a.reciprocal(product);
        let opposite = v2.conjugate(a);
        let beta = Complex { re, im }
            .times(v1.times(opposite, a), a)
            .scaled(over, a);
        let reach = a.mul(far, first);
        let over = a.reciprocal(reach);
        let link = Complex {
            re: a.add(first, re),
            im: a.scale(-1.0, im),
        };
        let opposite = v1.conjugate(a);
        let alpha = w.times(opposite, a).times(link, a).scaled(over, a);
        [alpha, beta]
    }

    /// The known joints of a part of the ring, the unknown ones at 0.
    fn product<A: Algebra>(
        &self,
        places: std::ops::Range<usize>,
        a: &mut A,
    ) -> Displacement<A::Value> {
        let mut product = Displacement::NONE.constant(a);
        for place in places {
            let element = &self.ring.elements[place];
            if let Some(joint) = element.joint.filter(|_| !self.unknown.contains(&place)) {
                let moved = element.moved(joint, a);
                product = product.times(&moved, a);
            }
        }
        product
    }

    /// How far positions are from closing the ring: in m, and a turn as its chord. `unknown` are
    /// those of the three joints.
    pub fn gap<A: Algebra<Value = f64>>(&self, unknown: [f64; 3], a: &mut A) -> f64 {
        let mut product = Displacement::NONE;
        for (place, element) in self.ring.elements.iter().enumerate() {
            let moved = match self.unknown.iter().position(|&known| known == place) {
                Some(index) => {
                    let (im, re) = (element.sign * unknown[index]).sin_cos();
                    element.turned(Complex { re, im }, a)
                }
                None => match element.joint {
                    Some(joint) => element.moved(joint, a),
                    None => Displacement::NONE,
                },
            };
            product = product.times(&moved, a);
        }
        let turn = product.turn.minus(self.ring.target.turn, a);
        let shift = product.shift.minus(self.ring.target.shift, a);
        turn.re.hypot(turn.im).max(shift.re.hypot(shift.im))
    }
}
