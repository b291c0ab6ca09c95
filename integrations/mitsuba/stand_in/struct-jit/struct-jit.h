// Stands in for a header that Mitsuba's headers include but its package on PyPI leaves out.
//
// Only `mitsuba::Bitmap` and tensor files have members of these types. The plugins use neither, so
// that the names are enough; nothing here has the layout of the original.

#pragma once

namespace struct_jit {

enum class Type { Float16 };

struct Struct {};

template <typename T> struct type_id;

template <typename T> constexpr Type type_v = type_id<T>::value;

} // namespace struct_jit
