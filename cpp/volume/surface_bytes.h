// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as bytes and back, bit by bit: what a saved volume keeps of it. Internal to cpp/volume.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "volume/surface.h"

namespace sightbound {

// Numbers and lists one after the other, low byte first.
class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof(T));
  }
  template <class T>
  void put_list(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::uint64_t{values.size()});
    append(values.data(), values.size_bytes());
  }
  void put_text(const std::string& text) { put_list(std::span<const char>(text)); }

  std::vector<char>& bytes() { return bytes_; }

 private:
  void append(const void* from, std::size_t count) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + count);
    if (count > 0) std::memcpy(bytes_.data() + at, from, count);
  }

  std::vector<char> bytes_;
};

// Throws IoError where the bytes end early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const char> bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> get_list() {
    const auto count = get<std::uint64_t>();
    if (count > bytes_.size() / sizeof(T)) take(bytes_.size() + 1);
    std::vector<T> values(static_cast<std::size_t>(count));
    const char* from = take(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), from, values.size() * sizeof(T));
    return values;
  }
  std::string get_text() {
    const std::vector<char> text = get_list<char>();
    return {text.begin(), text.end()};
  }

 private:
  const char* take(std::size_t count) {
    if (count > bytes_.size() - at_) throw IoError("The volume's surface is cut off. Make the file again.");
    const char* from = bytes_.data() + at_;
    at_ += count;
    return from;
  }

  std::span<const char> bytes_;
  std::size_t at_ = 0;
};

void write_surface(const Surface& surface, ByteWriter& to);
// Throws IoError, InvalidInput for what no surface can be made of.
std::shared_ptr<const Surface> read_surface(ByteReader& from);

}  // namespace sightbound
