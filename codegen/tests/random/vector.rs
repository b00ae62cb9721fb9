//! Vectors and matrices of three, as little as a recursion needs.

pub type Vector = [f64; 3];
pub type Matrix = [Vector; 3];

pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn scale(s: f64, a: Vector) -> Vector {
    a.map(|x| s * x)
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn transposed(a: Matrix) -> Matrix {
    [0, 1, 2].map(|i| [a[0][i], a[1][i], a[2][i]])
}

pub fn times(a: Matrix, x: Vector) -> Vector {
    a.map(|row| dot(row, x))
}

pub fn product(a: Matrix, b: Matrix) -> Matrix {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(row, column)))
}

/// Rodrigues: the rotation by `angle` about a unit axis.
pub fn about(axis: Vector, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    let [x, y, z] = axis;
    let t = 1.0 - c;
    [
        [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
        [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
        [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
    ]
}

/// Roll, pitch, yaw about fixed axes.
pub fn of_rpy([roll, pitch, yaw]: Vector) -> Matrix {
    let x = about([1.0, 0.0, 0.0], roll);
    let y = about([0.0, 1.0, 0.0], pitch);
    let z = about([0.0, 0.0, 1.0], yaw);
    product(z, product(y, x))
}
