// SPDX-License-Identifier: GPL-3.0-or-later
// Expat calls back element by element, so that only the surface wanted is held in memory:
//   LandXML > Units, CoordinateSystem, Surfaces > Surface[name] > Definition[surfType=TIN] > Pnts > P[id],
//   Faces > F[i]
// A P is "northing easting elevation"; an F of i="1" is invisible and left out.
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>

#include <expat.h>

#include "io/tin_formats.h"
#include "io/tin_text.h"

namespace sightbound {

namespace {

constexpr std::array<std::pair<std::string_view, double>, 9> kUnits{{{"meter", 1},
                                                                     {"metre", 1},
                                                                     {"millimeter", 0.001},
                                                                     {"centimeter", 0.01},
                                                                     {"kilometer", 1000},
                                                                     {"foot", 0.3048},
                                                                     {"USSurveyFoot", 1200.0 / 3937.0},
                                                                     {"inch", 0.0254},
                                                                     {"mile", 1609.344}}};

class Reader {
 public:
  // Without `wanted` the first surface is kept; with `names_only` none.
  Reader(const std::string& what, const std::vector<std::string>& wanted, bool names_only, Progress& progress)
      : what_(what), wanted_(wanted), names_only_(names_only), progress_(progress) {}

  void read(std::string_view bytes) {
    constexpr std::size_t kChunk = 1 << 20;
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                              XML_ParserFree);
    if (!parser) throw std::bad_alloc();
    parser_ = parser.get();
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(parser_, on_start, on_end);
    XML_SetCharacterDataHandler(parser_, on_text);
    for (bool last = false; !last;) {
      const std::string_view chunk = bytes.substr(0, kChunk);
      bytes.remove_prefix(chunk.size());
      last = bytes.empty();
      const XML_Status status =
          XML_Parse(parser_, chunk.data(), static_cast<int>(chunk.size()), last ? 1 : 0);
      if (thrown_) std::rethrow_exception(thrown_);
      if (status != XML_STATUS_OK) {
        const std::string where = what_ + " is no well-formed XML: line " +
                                  std::to_string(XML_GetCurrentLineNumber(parser_)) + ": " +
                                  XML_ErrorString(XML_GetErrorCode(parser_)) + ".";
        if (last) throw IoError(where + " It may be truncated.");
        throw InvalidInput(where + " Export it again.");
      }
      progress_.check();
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  bool kept_any() const { return kept_; }

  TinSource take() {
    FaceCollector collector(source_.tin, what_);
    std::vector<std::int32_t> corners;
    std::size_t begin = 0;
    for (std::size_t f = 0; f < ends_.size(); ++f) {
      corners.clear();
      for (std::size_t i = begin; i < ends_[f]; ++i) {
        const auto found = index_.find(corners_[i]);
        if (found == index_.end()) {
          throw InvalidInput(what_ + ": face " + std::to_string(f) + " (counted from 0) has point " +
                             std::to_string(corners_[i]) + ", which does not exist. Export it again.");
        }
        corners.push_back(found->second);
      }
      collector.add(corners);
      begin = ends_[f];
    }
    collector.finish({});
    if (invisible_ > 0)
      source_.tin.notes.push_back(std::to_string(invisible_) + " invisible faces left out.");
    return std::move(source_);
  }

 private:
  using Attributes = const XML_Char**;

  // No exception may pass through expat: the first one is kept and stops the parser.
  template <class F>
  static void guarded(void* self, const F& f) {
    auto& reader = *static_cast<Reader*>(self);
    if (reader.thrown_) return;
    try {
      f(reader);
    } catch (...) {
      reader.thrown_ = std::current_exception();
      XML_StopParser(reader.parser_, XML_FALSE);
    }
  }
  static void XMLCALL on_start(void* self, const XML_Char* name, Attributes attributes) {
    guarded(self, [&](Reader& reader) { reader.start(local(name), attributes); });
  }
  static void XMLCALL on_end(void* self, const XML_Char* name) {
    guarded(self, [&](Reader& reader) { reader.end(local(name)); });
  }
  static void XMLCALL on_text(void* self, const XML_Char* text, int length) {
    guarded(self, [&](Reader& reader) {
      if (reader.collecting_) reader.text_.append(text, static_cast<std::size_t>(length));
    });
  }

  static std::string_view local(std::string_view name) {
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
  }
  static std::string_view attribute(Attributes attributes, std::string_view wanted) {
    for (; attributes[0] != nullptr; attributes += 2) {
      if (attributes[0] == wanted) return attributes[1];
    }
    return {};
  }

  void start(std::string_view name, Attributes attributes) {
    if (name == "Metric" || name == "Imperial") {
      set_unit(attribute(attributes, "linearUnit"));
    } else if (name == "CoordinateSystem") {
      set_crs(attributes);
    } else if (name == "Surface") {
      start_surface(std::string(attribute(attributes, "name")));
    } else if (name == "Definition" && inside_) {
      const std::string_view type = attribute(attributes, "surfType");
      if (!type.empty() && type != "TIN") {
        throw InvalidInput(what_ + ": surface '" + names_.back() + "' is of type '" + text::shown(type) +
                           "'; only TIN surfaces can be read.");
      }
      in_definition_ = true;
    } else if (in_definition_ && (name == "P" || name == "F")) {
      collecting_ = true;
      text_.clear();
      if (name == "P") point_ = text::number<std::int64_t>(attribute(attributes, "id")).value_or(next_point_);
      visible_ = attribute(attributes, "i") != "1";
    }
  }

  void end(std::string_view name) {
    if (name == "Surface") inside_ = in_definition_ = false;
    if (name == "Definition") in_definition_ = false;
    if (!collecting_) return;
    if (name == "P") add_point();
    if (name == "F") add_face();
    if (name == "P" || name == "F") collecting_ = false;
  }

  void set_unit(std::string_view unit) {
    for (const auto& [name, metres] : kUnits) {
      if (name == unit) {
        source_.unit = TinSource::Unit{metres, std::string(name)};
        return;
      }
    }
    if (!unit.empty()) {
      source_.tin.notes.push_back("The unit '" + text::shown(unit) +
                                  "' is unknown: lengths are taken as those of the CRS, or metres.");
    }
  }

  void set_crs(Attributes attributes) {
    const std::string_view code = attribute(attributes, "epsgCode"),
                           wkt = attribute(attributes, "ogcWktCode");
    if (text::number<int>(code)) {
      source_.crs = "EPSG:" + std::string(code);
    } else if (!wkt.empty()) {
      source_.crs = wkt;
    }
  }

  void start_surface(std::string name) {
    const bool wanted = wanted_.empty() ? names_.empty() : name == wanted_.front();
    inside_ = wanted && !names_only_ && !kept_;
    kept_ = kept_ || inside_;
    names_.push_back(std::move(name));
  }

  [[noreturn]] void damaged(const std::string& how) const {
    throw InvalidInput(what_ + ": line " + std::to_string(XML_GetCurrentLineNumber(parser_)) + " " + how +
                       ".");
  }

  void add_point() {
    std::string_view words = text_;
    std::array<double, 3> values{};
    for (double& value : values) {
      const std::string_view word = text::next_word(words);
      const auto found = text::number<double>(word);
      if (!found)
        damaged("has a point of '" + text::shown(text_) +
                "'; three numbers are needed: northing easting elevation");
      value = *found;
    }
    const auto index = static_cast<std::int32_t>(source_.tin.vertices.size());
    if (!index_.emplace(point_, index).second) damaged("repeats point " + std::to_string(point_));
    next_point_ = point_ < std::numeric_limits<std::int64_t>::max() ? point_ + 1 : point_;
    source_.tin.vertices.push_back({values[1], values[0], values[2]});
  }

  void add_face() {
    if (!visible_) {
      ++invisible_;
      return;
    }
    std::string_view words = text_;
    for (std::string_view word = text::next_word(words); !word.empty(); word = text::next_word(words)) {
      const auto found = text::number<std::int64_t>(word);
      if (!found) damaged("has '" + text::shown(word) + "' for a corner");
      corners_.push_back(*found);
    }
    ends_.push_back(corners_.size());
  }

  const std::string& what_;
  const std::vector<std::string>& wanted_;
  const bool names_only_;
  Progress& progress_;
  XML_Parser parser_ = nullptr;
  std::exception_ptr thrown_;

  std::vector<std::string> names_;
  bool inside_ = false, in_definition_ = false, kept_ = false, collecting_ = false, visible_ = true;
  std::string text_;
  std::int64_t point_ = 0, next_point_ = 1;
  std::size_t invisible_ = 0;

  TinSource source_;
  std::unordered_map<std::int64_t, std::int32_t> index_;
  std::vector<std::int64_t> corners_;
  std::vector<std::size_t> ends_;
};

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

}  // namespace

std::vector<std::string> landxml_surfaces(std::string_view bytes, const std::string& what,
                                          Progress& progress) {
  const std::vector<std::string> none;
  Reader reader(what, none, true, progress);
  reader.read(bytes);
  return reader.names();
}

TinSource parse_landxml(std::string_view bytes, const std::vector<std::string>& surfaces,
                        const std::string& what, Progress& progress) {
  if (surfaces.size() > 1) {
    throw InvalidInput(what + ": " + std::to_string(surfaces.size()) +
                       " layers are named; one surface can be read at a time.");
  }
  Reader reader(what, surfaces, false, progress);
  reader.read(bytes);
  const std::vector<std::string>& names = reader.names();
  if (names.empty()) throw InvalidInput(what + " has no surface; export one of type TIN.");
  if (!reader.kept_any()) {
    throw InvalidInput(what + " has no surface '" + surfaces.front() + "'; there are " + listed(names) + ".");
  }
  if (surfaces.empty() && names.size() > 1) {
    throw InvalidInput(what + " has several surfaces: " + listed(names) + ". Name one as layer.");
  }
  return reader.take();
}

}  // namespace sightbound
