#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>

/// Arrays of numpy, by Python's buffer protocol: an `nb::ndarray` costs five times as long to take
/// and to give, which is more than an answer of inverse kinematics takes.
namespace mjarm::python {

/// What numpy calls such numbers.
template <class T>
inline constexpr char kTypeCode = 0;
template <>
inline constexpr char kTypeCode<double> = 'd';
template <>
inline constexpr char kTypeCode<float> = 'f';
template <>
inline constexpr char kTypeCode<std::uint8_t> = 'B';
template <>
inline constexpr char kTypeCode<bool> = '?';

/// The numbers of an array, in C order, without a copy; keeps it alive. `T` is const where they are
/// only read.
template <class T>
class View {
 public:
  /// None where `object` has no such numbers, or ones that may not be written.
  static std::optional<View> of(nanobind::handle object) {
    if (!PyObject_CheckBuffer(object.ptr())) return std::nullopt;
    auto buffer = std::make_unique<Py_buffer>();
    const int flags = PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | (std::is_const_v<T> ? 0 : PyBUF_WRITABLE);
    if (PyObject_GetBuffer(object.ptr(), buffer.get(), flags) != 0) {
      PyErr_Clear();
      return std::nullopt;
    }
    View view(buffer.release());
    const char* const code = view.buffer_->format == nullptr ? "B" : view.buffer_->format;
    const bool fits = code[0] == kTypeCode<std::remove_const_t<T>> && code[1] == '\0' &&
                      reinterpret_cast<std::uintptr_t>(view.data()) % alignof(T) == 0;
    return fits ? std::optional(std::move(view)) : std::nullopt;
  }

  [[nodiscard]] T* data() const { return static_cast<T*>(buffer_->buf); }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(buffer_->len / buffer_->itemsize);
  }
  [[nodiscard]] std::size_t ndim() const { return static_cast<std::size_t>(buffer_->ndim); }
  [[nodiscard]] std::size_t shape(std::size_t i) const {
    return static_cast<std::size_t>(buffer_->shape[i]);
  }
  [[nodiscard]] std::span<T> span() const { return {data(), size()}; }

 private:
  struct Release {
    void operator()(Py_buffer* buffer) const {
      PyBuffer_Release(buffer);
      delete buffer;
    }
  };
  explicit View(Py_buffer* buffer) : buffer_(buffer) {}
  std::unique_ptr<Py_buffer, Release> buffer_;  // on the heap: some point into themselves
};

/// numpy.empty(shape, dtype).
[[nodiscard]] nanobind::object empty_array(char type_code,
                                           std::initializer_list<std::size_t> shape);

/// A new array of numpy, and where its numbers go.
template <class T>
struct NewArray {
  explicit NewArray(std::initializer_list<std::size_t> shape)
      : object(empty_array(kTypeCode<T>, shape)), data(View<T>::of(object)->data()) {}

  nanobind::object object;
  T* data;
};

/// A new array of numpy with these numbers, in rows.
template <class T, class Values>
[[nodiscard]] nanobind::object array(const Values& values,
                                     std::initializer_list<std::size_t> shape) {
  const NewArray<T> made(shape);
  std::copy(values.begin(), values.end(), made.data);
  return made.object;
}
[[nodiscard]] inline nanobind::object array(std::span<const double> values,
                                            std::initializer_list<std::size_t> shape) {
  return array<double>(values, shape);
}

}  // namespace mjarm::python
