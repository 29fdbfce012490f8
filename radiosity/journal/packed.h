#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

namespace lightwell {

template <class T>
concept EigenArray = requires {
  typename T::PlainObject;
};
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !EigenArray<T>;

/// Values as bytes, one after another: numbers and plain structs, vectors and spans of these, Eigen
/// arrays, and tuples of all these. Only the program that wrote the bytes can read them: sizes and
/// byte order are the machine's.
class Packed {
 public:
  template <Plain T>
  void add(const T& value) {
    add_bytes(std::as_bytes(std::span(&value, 1)));
  }
  template <Plain T>
  void add(const std::vector<T>& values) {
    add(std::span<const T>(values));
  }
  template <Plain T>
  void add(std::span<T> values) {
    add(values.size());
    add_bytes(std::as_bytes(values));
  }
  template <EigenArray T>
  void add(const T& values) {
    add(values.rows());
    add(values.cols());
    add_bytes(std::as_bytes(std::span(values.data(), static_cast<std::size_t>(values.size()))));
  }
  template <class... T>
  void add(const std::tuple<T...>& values) {
    std::apply([this](const auto&... each) { (add(each), ...); }, values);
  }

  std::span<const std::byte> bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  void add_bytes(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::byte> bytes_;
};

/// Takes values out in the order of adding. `take` returns false if the bytes do not hold the
/// value; a span must have the size of the span that was added.
class Unpacked {
 public:
  explicit Unpacked(std::span<const std::byte> bytes) : left_(bytes) {}

  template <Plain T>
  bool take(T& value) {
    return take_bytes(&value, sizeof value);
  }
  template <Plain T>
  bool take(std::vector<T>& values) {
    std::size_t count = 0;
    if (!take(count) || count > left_.size() / sizeof(T)) return false;
    values.resize(count);
    return take_bytes(values.data(), count * sizeof(T));
  }
  template <Plain T>
  bool take(std::span<T>& values) {
    std::size_t count = 0;
    return take(count) && count == values.size() && take_bytes(values.data(), count * sizeof(T));
  }
  template <EigenArray T>
  bool take(T& values) {
    constexpr std::size_t number = sizeof(typename T::Scalar);
    Eigen::Index rows = 0, cols = 0;
    if (!take(rows) || !take(cols)) return false;
    if (!fits(rows, T::RowsAtCompileTime, T::MaxRowsAtCompileTime) ||
        !fits(cols, T::ColsAtCompileTime, T::MaxColsAtCompileTime)) {
      return false;
    }
    const std::size_t most = left_.size() / number;
    if (cols > 0 && static_cast<std::size_t>(rows) > most / static_cast<std::size_t>(cols)) {
      return false;
    }
    values.resize(rows, cols);
    return take_bytes(values.data(), static_cast<std::size_t>(values.size()) * number);
  }
  template <class... T>
  bool take(std::tuple<T...>& values) {
    return std::apply([this](auto&... each) { return (take(each) && ...); }, values);
  }

  bool is_empty() const { return left_.empty(); }

 private:
  // True if an array whose type has `fixed` rows or columns, or at most `most`, can have `count`.
  static bool fits(Eigen::Index count, Eigen::Index fixed, Eigen::Index most) {
    return count >= 0 && (fixed == Eigen::Dynamic || count == fixed) &&
           (most == Eigen::Dynamic || count <= most);
  }
  bool take_bytes(void* to, std::size_t count) {
    if (count > left_.size()) return false;
    if (count > 0) std::memcpy(to, left_.data(), count);
    left_ = left_.subspan(count);
    return true;
  }
  std::span<const std::byte> left_;
};

}  // namespace lightwell
