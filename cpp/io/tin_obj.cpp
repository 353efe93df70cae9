// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <limits>

#include "io/tin_formats.h"
#include "io/tin_text.h"

namespace sightbound {

namespace {

class ObjReader {
 public:
  ObjReader(TinSource& source, const std::string& what) : source_(source), what_(what) {}

  void line(std::string_view words) {
    ++line_;
    const std::string_view key = text::next_word(words);
    if (key == "v") {
      add_vertex(words);
    } else if (key == "f") {
      add_face(words);
    } else if (key == "#" && source_.crs.empty()) {
      words = text::trimmed(words);
      if (words.starts_with("crs:")) source_.crs = text::trimmed(words.substr(4));
    }
  }

  // Vertices may follow the faces that use them.
  void finish() {
    FaceCollector collector(source_.tin, what_);
    std::size_t begin = 0;
    for (const std::size_t end : ends_) {
      collector.add({corners_.data() + begin, end - begin});
      begin = end;
    }
    collector.finish({});
  }

 private:
  [[noreturn]] void damaged(const std::string& how) const {
    throw InvalidInput(what_ + ": line " + std::to_string(line_) + " " + how + ". Export it again.");
  }

  void add_vertex(std::string_view words) {
    Xyz v;
    for (double* coordinate : {&v.x, &v.y, &v.z}) {
      const std::string_view word = text::next_word(words);
      const auto found = text::number<double>(word);
      if (!found) damaged("has '" + text::shown(word) + "' for a coordinate");
      *coordinate = *found;
    }
    source_.tin.vertices.push_back(v);
  }

  // 7, 7/1, 7/1/2, 7//2; counted from 1, or from the last vertex back when negative.
  void add_face(std::string_view words) {
    while (true) {
      const std::string_view word = text::next_word(words);
      if (word.empty() || word.front() == '#') break;
      const auto found = text::number<std::int64_t>(word.substr(0, word.find('/')));
      if (!found || *found == 0) damaged("has '" + text::shown(word) + "' for a corner");
      const std::int64_t index =
          *found > 0 ? *found - 1 : static_cast<std::int64_t>(source_.tin.vertices.size()) + *found;
      const bool possible = index >= 0 && index <= std::numeric_limits<std::int32_t>::max();
      corners_.push_back(possible ? static_cast<std::int32_t>(index) : -1);
    }
    ends_.push_back(corners_.size());
  }

  TinSource& source_;
  const std::string& what_;
  std::size_t line_ = 0;
  std::vector<std::int32_t> corners_;
  std::vector<std::size_t> ends_;
};

}  // namespace

TinSource parse_obj(std::string_view bytes, const std::string& what, Progress& progress) {
  TinSource source;
  ObjReader reader(source, what);
  text::read_lines(bytes, reader, progress);
  return source;
}

}  // namespace sightbound
