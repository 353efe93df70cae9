// SPDX-License-Identifier: GPL-3.0-or-later
// Words and numbers of text formats, read in place. Internal to cpp/io.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/progress.h"

namespace sightbound::text {

inline bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

// The first word of `rest`, which is shortened by it; empty at the end.
inline std::string_view next_word(std::string_view& rest) {
  std::size_t begin = 0;
  while (begin < rest.size() && is_space(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_space(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// The first line of `rest` without its end ("\n", "\r\n" or "\r"), which is shortened by it. Empty optional
// at the end.
inline std::optional<std::string_view> next_line(std::string_view& rest) {
  if (rest.empty()) return {};
  const std::size_t end = rest.find_first_of("\r\n");
  const std::string_view line = rest.substr(0, end);
  if (end == std::string_view::npos) {
    rest = {};
  } else {
    const bool both = rest[end] == '\r' && end + 1 < rest.size() && rest[end + 1] == '\n';
    rest.remove_prefix(end + (both ? 2 : 1));
  }
  return line;
}

// Hands every line of a text to `reader.line`, then ends it.
template <class Reader>
void read_lines(std::string_view bytes, Reader& reader, Progress& progress) {
  constexpr std::size_t kLinesPerCheck = 1 << 14;
  std::size_t lines = 0;
  while (const auto line = next_line(bytes)) {
    reader.line(*line);
    if (++lines % kLinesPerCheck == 0) progress.check();
  }
  reader.finish();
}

// The whole word is a number, whatever the locale. "nan" and "inf" are.
template <class T>
std::optional<T> number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  T value{};
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

// For messages: no more than a few letters of it, and nothing unprintable.
inline std::string shown(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string out;
  for (const char c : word.substr(0, kMost)) out += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > kMost ? out + "..." : out;
}

}  // namespace sightbound::text
