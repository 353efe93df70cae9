// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>

#include "io/tin_formats.h"
#include "io/tin_text.h"

namespace sightbound {

namespace {

// Elements, and which of their nodes are corners: quadratic ones have a node in the middle of each side.
struct Kind {
  std::string_view card;
  int nodes, corners, step;
};
constexpr std::array<Kind, 5> kKinds{
    {{"E3T", 3, 3, 1}, {"E4Q", 4, 4, 1}, {"E6T", 6, 3, 2}, {"E8Q", 8, 4, 2}, {"E9Q", 9, 4, 2}}};

class MeshReader {
 public:
  MeshReader(TinSource& source, const std::string& what) : source_(source), what_(what) {}

  void line(std::string_view words) {
    ++line_;
    const std::string_view card = text::next_word(words);
    if (card == "ND") return add_node(words);
    for (const Kind& kind : kKinds) {
      if (card == kind.card) return add_element(kind, words);
    }
  }

  // Nodes may follow the elements that use them; their numbers are any.
  void finish() {
    FaceCollector collector(source_.tin, what_);
    std::vector<std::int32_t> corners;
    std::size_t begin = 0;
    for (std::size_t e = 0; e < ends_.size(); ++e) {
      corners.clear();
      for (std::size_t i = begin; i < ends_[e]; ++i) corners.push_back(index_of(nodes_[i], e));
      collector.add(corners);
      begin = ends_[e];
    }
    std::vector<TinAttribute> attributes;
    const bool told =
        std::any_of(materials_.begin(), materials_.end(), [&](float m) { return m != materials_.front(); });
    if (told) attributes.push_back({"material", std::move(materials_)});
    collector.finish(std::move(attributes));
    if (quadratic_ > 0) {
      source_.tin.notes.push_back(std::to_string(quadratic_) + " quadratic elements taken by their corners.");
    }
  }

 private:
  [[noreturn]] void damaged(const std::string& how) const {
    throw InvalidInput(what_ + ": line " + std::to_string(line_) + " " + how + ". Export it again.");
  }

  std::int64_t whole_number(std::string_view& words) const {
    const std::string_view word = text::next_word(words);
    const auto found = text::number<std::int64_t>(word);
    if (!found) damaged("has '" + text::shown(word) + "' where a whole number should be");
    return *found;
  }

  void add_node(std::string_view words) {
    const std::int64_t id = whole_number(words);
    Xyz v;
    for (double* coordinate : {&v.x, &v.y, &v.z}) {
      const std::string_view word = text::next_word(words);
      const auto found = text::number<double>(word);
      if (!found) damaged("has '" + text::shown(word) + "' for a coordinate");
      *coordinate = *found;
    }
    const auto index = static_cast<std::int32_t>(source_.tin.vertices.size());
    // Mostly 1, 2, 3 ...: those need no table.
    if (!listed_ && id != index + std::int64_t{1}) {
      for (std::int32_t i = 0; i < index; ++i) index_.emplace(i + std::int64_t{1}, i);
      listed_ = true;
    }
    if (listed_ && !index_.emplace(id, index).second) damaged("repeats node " + std::to_string(id));
    source_.tin.vertices.push_back(v);
  }

  void add_element(const Kind& kind, std::string_view words) {
    whole_number(words);
    for (int n = 0; n < kind.nodes; ++n) {
      const std::int64_t node = whole_number(words);
      if (n % kind.step == 0 && n / kind.step < kind.corners) nodes_.push_back(node);
    }
    ends_.push_back(nodes_.size());
    materials_.push_back(text::number<float>(text::next_word(words)).value_or(0));
    quadratic_ += kind.step == 2;
  }

  std::int32_t index_of(std::int64_t node, std::size_t element) const {
    if (!listed_ && node >= 1 && node <= static_cast<std::int64_t>(source_.tin.vertices.size())) {
      return static_cast<std::int32_t>(node - 1);
    }
    const auto found = index_.find(node);
    if (found == index_.end()) {
      throw InvalidInput(what_ + ": element " + std::to_string(element + 1) + " has node " +
                         std::to_string(node) + ", which does not exist. Export it again.");
    }
    return found->second;
  }

  TinSource& source_;
  const std::string& what_;
  std::size_t line_ = 0, quadratic_ = 0;
  bool listed_ = false;
  std::unordered_map<std::int64_t, std::int32_t> index_;
  std::vector<std::int64_t> nodes_;
  std::vector<std::size_t> ends_;
  std::vector<float> materials_;
};

}  // namespace

TinSource parse_2dm(std::string_view bytes, const std::string& what, Progress& progress) {
  TinSource source;
  MeshReader reader(source, what);
  text::read_lines(bytes, reader, progress);
  return source;
}

}  // namespace sightbound
