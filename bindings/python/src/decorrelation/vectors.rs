use numpy::PyArray1;
use pyo3::prelude::*;
use tem00_decorrelation::{DMat3, DVec2, DVec3};

use crate::{
    arrays::{Numbers, vector_array},
    error::refused,
};

/// A vector of the world as an array of shape (3,).
pub(super) type Array3<'py> = Bound<'py, PyArray1<f64>>;

/// A vector in the pupil or the image as an array of shape (2,).
pub(super) type Array2<'py> = Bound<'py, PyArray1<f64>>;

/// Returns an argument as a vector of the world.
pub(super) fn vec3(name: &'static str, argument: &Numbers<'_>) -> PyResult<DVec3> {
    Ok(DVec3::from_array(argument.vector(name)?))
}

/// Returns an argument as a vector in the pupil or the image.
pub(super) fn vec2(name: &'static str, argument: &Numbers<'_>) -> PyResult<DVec2> {
    Ok(DVec2::from_array(argument.vector(name)?))
}

/// Returns an argument of shape (N, 3) as vectors of the world.
pub(super) fn rows<const N: usize>(
    name: &'static str,
    argument: &Numbers<'_>,
) -> PyResult<[DVec3; N]> {
    let values = argument.finite(name)?;
    if argument.shape() != [N, 3] {
        let shape = argument.shape();
        let message = format!("{name} has the shape {shape:?}, but must have [{N}, 3]");
        return Err(refused(name, message));
    }
    Ok(core::array::from_fn(|i| {
        DVec3::from_slice(&values[3 * i..])
    }))
}

/// Returns an argument of shape (3, 3) as a matrix.
pub(super) fn mat3(name: &'static str, argument: &Numbers<'_>) -> PyResult<DMat3> {
    // Rows of NumPy are columns of the transpose.
    let [x, y, z] = rows(name, argument)?;
    Ok(DMat3::from_cols(x, y, z).transpose())
}

/// Returns a unit vector, or another that is finite, as an array.
pub(super) fn array3(py: Python<'_>, vector: DVec3) -> Array3<'_> {
    vector_array(py, vector.to_array())
}

/// Returns a vector in the pupil or the image, which follows from the argument `name`, as an array.
///
/// # Errors
///
/// Refuses an argument so extreme that the vector is NaN.
pub(super) fn array2<'py>(
    py: Python<'py>,
    name: &'static str,
    vector: DVec2,
) -> PyResult<Array2<'py>> {
    Ok(vector_array(py, numbers(name, vector)?.to_array()))
}

/// Returns a vector that follows from the argument `name`.
///
/// # Errors
///
/// Refuses an argument so extreme that the vector is NaN.
pub(super) fn numbers(name: &'static str, vector: DVec2) -> PyResult<DVec2> {
    if vector.is_nan() {
        let message = format!("{name} must be less extreme to have a result");
        return Err(refused(name, message));
    }
    Ok(vector)
}

/// Writes a vector as Python does.
pub(super) fn shown(vector: DVec3) -> String {
    format!("{:?}", vector.to_array())
}

/// Writes a matrix as Python does, row by row.
pub(super) fn shown33(matrix: DMat3) -> String {
    let rows = matrix.transpose();
    let rows = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.to_array());
    format!("{rows:?}")
}
