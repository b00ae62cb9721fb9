//! Displacements of a plane over any kind of number: the geometry of loops is written once, for
//! values and for expressions of the graph.

/// A kind of number with the positions of joints.
pub trait Algebra {
    /// The number.
    type Value: Copy;
    /// A constant.
    fn constant(&mut self, value: f64) -> Self::Value;
    /// `a + b`.
    fn add(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    /// `a * b`.
    fn mul(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    /// Square root; NaN of a negative number.
    fn root(&mut self, a: Self::Value) -> Self::Value;
    /// 1/a.
    fn reciprocal(&mut self, a: Self::Value) -> Self::Value;
    /// Cosine and sine of a joint's position.
    fn turn(&mut self, joint: usize) -> Complex<Self::Value>;
    /// A joint's position.
    fn position(&mut self, joint: usize) -> Self::Value;

    /// `factor * a`.
    fn scale(&mut self, factor: f64, a: Self::Value) -> Self::Value {
        let factor = self.constant(factor);
        self.mul(factor, a)
    }

    /// `a - b`.
    fn sub(&mut self, a: Self::Value, b: Self::Value) -> Self::Value {
        let opposite = self.scale(-1.0, b);
        self.add(a, opposite)
    }
}

/// A vector of the plane, or a turn as cosine and sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex<V> {
    /// Along the first axis; a cosine.
    pub re: V,
    /// Along the second axis; a sine.
    pub im: V,
}

impl Complex<f64> {
    /// Its angle, rad, in (-pi, pi].
    pub fn angle(self) -> f64 {
        self.im.atan2(self.re)
    }

    /// A number as a kind of number.
    pub fn constant<A: Algebra>(self, a: &mut A) -> Complex<A::Value> {
        Complex {
            re: a.constant(self.re),
            im: a.constant(self.im),
        }
    }
}

impl<V: Copy> Complex<V> {
    /// `self + other`.
    pub fn plus<A: Algebra<Value = V>>(self, other: Self, a: &mut A) -> Self {
        Complex {
            re: a.add(self.re, other.re),
            im: a.add(self.im, other.im),
        }
    }

    /// `self - other`.
    pub fn minus<A: Algebra<Value = V>>(self, other: Self, a: &mut A) -> Self {
        Complex {
            re: a.sub(self.re, other.re),
            im: a.sub(self.im, other.im),
        }
    }

    /// `self * other`.
    pub fn times<A: Algebra<Value = V>>(self, other: Self, a: &mut A) -> Self {
        let (xx, yy) = (a.mul(self.re, other.re), a.mul(self.im, other.im));
        let (xy, yx) = (a.mul(self.re, other.im), a.mul(self.im, other.re));
        Complex {
            re: a.sub(xx, yy),
            im: a.add(xy, yx),
        }
    }

    /// A number times it.
    pub fn scaled<A: Algebra<Value = V>>(self, factor: V, a: &mut A) -> Self {
        Complex {
            re: a.mul(factor, self.re),
            im: a.mul(factor, self.im),
        }
    }

    /// The conjugate: the turn back.
    pub fn conjugate<A: Algebra<Value = V>>(self, a: &mut A) -> Self {
        Complex {
            im: a.scale(-1.0, self.im),
            ..self
        }
    }

    /// The square of its length.
    pub fn square<A: Algebra<Value = V>>(self, a: &mut A) -> V {
        let (xx, yy) = (a.mul(self.re, self.re), a.mul(self.im, self.im));
        a.add(xx, yy)
    }
}

/// x -> turn * x + shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement<V> {
    /// Rotation.
    pub turn: Complex<V>,
    /// Translation, m.
    pub shift: Complex<V>,
}

impl Displacement<f64> {
    /// None.
    pub const NONE: Displacement<f64> = Displacement {
        turn: Complex { re: 1.0, im: 0.0 },
        shift: Complex { re: 0.0, im: 0.0 },
    };

    /// A number as a kind of number.
    pub fn constant<A: Algebra>(self, a: &mut A) -> Displacement<A::Value> {
        Displacement {
            turn: self.turn.constant(a),
            shift: self.shift.constant(a),
        }
    }
}

impl<V: Copy> Displacement<V> {
    /// Where a point goes.
    pub fn of<A: Algebra<Value = V>>(&self, point: Complex<V>, a: &mut A) -> Complex<V> {
        self.turn.times(point, a).plus(self.shift, a)
    }

    /// `other` first, then `self`.
    pub fn times<A: Algebra<Value = V>>(&self, other: &Self, a: &mut A) -> Self {
        Displacement {
            turn: self.turn.times(other.turn, a),
            shift: self.of(other.shift, a),
        }
    }

    /// The way back.
    pub fn inverse<A: Algebra<Value = V>>(&self, a: &mut A) -> Self {
        let turn = self.turn.conjugate(a);
        let shift = turn.times(self.shift, a);
        Displacement {
            turn,
            shift: Complex {
                re: a.scale(-1.0, shift.re),
                im: a.scale(-1.0, shift.im),
            },
        }
    }
}

/// Plain numbers, with the positions of joints.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<'a>(pub &'a [f64]);

impl Algebra for Numbers<'_> {
    type Value = f64;
    fn constant(&mut self, value: f64) -> f64 {
        value
    }
    fn add(&mut self, a: f64, b: f64) -> f64 {
        a + b
    }
    fn mul(&mut self, a: f64, b: f64) -> f64 {
        a * b
    }
    fn root(&mut self, a: f64) -> f64 {
        a.sqrt()
    }
    fn reciprocal(&mut self, a: f64) -> f64 {
        a.recip()
    }
    fn turn(&mut self, joint: usize) -> Complex<f64> {
        let (im, re) = self.position(joint).sin_cos();
        Complex { re, im }
    }
    fn position(&mut self, joint: usize) -> f64 {
        self.0.get(joint).copied().unwrap_or(f64::NAN)
    }
}
