// SPDX-License-Identifier: GPL-3.0-or-later
// The header's elements are read one after the other through one of two sources of values, words of text or
// bytes. Counts are checked against the bytes that are left before anything is made room for.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <utility>

#include "io/tin_formats.h"
#include "io/tin_text.h"

namespace sightbound {

namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct NamedType {
  std::string_view name;
  Type type;
};
constexpr std::array<NamedType, 16> kTypes{{{"char", Type::kInt8},
                                            {"int8", Type::kInt8},
                                            {"uchar", Type::kUint8},
                                            {"uint8", Type::kUint8},
                                            {"short", Type::kInt16},
                                            {"int16", Type::kInt16},
                                            {"ushort", Type::kUint16},
                                            {"uint16", Type::kUint16},
                                            {"int", Type::kInt32},
                                            {"int32", Type::kInt32},
                                            {"uint", Type::kUint32},
                                            {"uint32", Type::kUint32},
                                            {"float", Type::kFloat},
                                            {"float32", Type::kFloat},
                                            {"double", Type::kDouble},
                                            {"float64", Type::kDouble}}};
constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};

std::size_t size_of(Type type) { return kSizes[static_cast<std::size_t>(type)]; }
bool is_real(Type type) { return type == Type::kFloat || type == Type::kDouble; }

struct Property {
  std::string name;
  Type type = Type::kFloat;
  bool list = false;
  Type count_type = Type::kUint8;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool ascii = true, swapped = false;
  std::string crs;
  std::vector<Element> elements;
};

class Complaint {
 public:
  explicit Complaint(const std::string& what) : what_(what) {}
  // Parts of one sentence.
  [[noreturn]] void damaged(std::initializer_list<std::string_view> how) const {
    std::string message = what_ + " is no PLY file that can be read: ";
    for (const std::string_view part : how) message.append(part);
    throw InvalidInput(message.append(". Export it again."));
  }
  [[noreturn]] void truncated(const Element& element, std::size_t done) const {
    throw IoError(what_ + " is truncated: it ends in element '" + element.name + "' " + std::to_string(done) +
                  " of " + std::to_string(element.count) + ".");
  }

 private:
  const std::string& what_;
};

Type type_named(std::string_view name, const Complaint& complaint) {
  for (const NamedType& one : kTypes) {
    if (one.name == name) return one.type;
  }
  complaint.damaged({"property type '", text::shown(name), "' is unknown"});
}

void add_property(Header& header, std::string_view words, const Complaint& complaint) {
  if (header.elements.empty()) complaint.damaged({"a property comes before the first element"});
  Property property;
  std::string_view type = text::next_word(words);
  if (type == "list") {
    property.list = true;
    property.count_type = type_named(text::next_word(words), complaint);
    if (is_real(property.count_type)) complaint.damaged({"a list's length is no whole number"});
    type = text::next_word(words);
  }
  property.type = type_named(type, complaint);
  property.name = text::next_word(words);
  header.elements.back().properties.push_back(std::move(property));
}

void add_comment(Header& header, std::string_view words) {
  words = text::trimmed(words);
  if (words.size() < 4) return;
  std::string key(words.substr(0, 4));
  std::transform(key.begin(), key.end(), key.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (key == "crs:") header.crs = text::trimmed(words.substr(4));
}

Header read_header(std::string_view& rest, const Complaint& complaint) {
  Header header;
  bool format_said = false;
  if (text::next_word(rest) != "ply") complaint.damaged({"it does not begin with 'ply'"});
  text::next_line(rest);
  while (true) {
    const auto line = text::next_line(rest);
    if (!line) complaint.damaged({"its header does not end"});
    std::string_view words = *line;
    const std::string_view key = text::next_word(words);
    if (key == "end_header") break;
    if (key == "format") {
      const std::string_view format = text::next_word(words);
      format_said = true;
      header.ascii = format == "ascii";
      const bool big = format == "binary_big_endian";
      if (!header.ascii && !big && format != "binary_little_endian") {
        complaint.damaged({"format '", text::shown(format), "' is unknown"});
      }
      header.swapped = !header.ascii && big != (std::endian::native == std::endian::big);
    } else if (key == "element") {
      Element element;
      element.name = text::next_word(words);
      const auto count = text::number<std::uint64_t>(text::next_word(words));
      if (!count) complaint.damaged({"element '", text::shown(element.name), "' has no count"});
      element.count = static_cast<std::size_t>(*count);
      header.elements.push_back(std::move(element));
    } else if (key == "property") {
      add_property(header, words, complaint);
    } else if (key == "comment") {
      add_comment(header, words);
    }
  }
  if (!format_said) complaint.damaged({"its header names no format"});
  return header;
}

// Values of either encoding, one after the other; false at the end.
class Values {
 public:
  Values(std::string_view rest, const Header& header, const Complaint& complaint)
      : rest_(rest), ascii_(header.ascii), swapped_(header.swapped), complaint_(complaint) {}

  std::size_t left() const { return rest_.size(); }
  bool ascii() const { return ascii_; }

  bool next(Type type, double& value) { return ascii_ ? next_word(value) : next_bytes(type, value); }

 private:
  bool next_word(double& value) {
    const std::string_view word = text::next_word(rest_);
    if (word.empty()) return false;
    const auto found = text::number<double>(word);
    if (!found) complaint_.damaged({"'", text::shown(word), "' is no number"});
    value = *found;
    return true;
  }

  template <class T>
  static double as(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
  }

  bool next_bytes(Type type, double& value) {
    const std::size_t size = size_of(type);
    if (rest_.size() < size) return false;
    std::array<char, 8> bytes{};
    std::copy_n(rest_.begin(), size, bytes.begin());
    if (swapped_) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    rest_.remove_prefix(size);
    switch (type) {
      case Type::kInt8:
        value = as<std::int8_t>(bytes);
        break;
      case Type::kUint8:
        value = as<std::uint8_t>(bytes);
        break;
      case Type::kInt16:
        value = as<std::int16_t>(bytes);
        break;
      case Type::kUint16:
        value = as<std::uint16_t>(bytes);
        break;
      case Type::kInt32:
        value = as<std::int32_t>(bytes);
        break;
      case Type::kUint32:
        value = as<std::uint32_t>(bytes);
        break;
      case Type::kFloat:
        value = as<float>(bytes);
        break;
      case Type::kDouble:
        value = as<double>(bytes);
        break;
    }
    return true;
  }

  std::string_view rest_;
  bool ascii_, swapped_;
  const Complaint& complaint_;
};

// Least bytes that an element's rows can take: a digit and a blank a word, or the sizes of its values.
std::size_t least_bytes(const Element& element, bool ascii) {
  std::size_t bytes = 0;
  for (const Property& property : element.properties) {
    bytes += ascii ? 2 : size_of(property.list ? property.count_type : property.type);
  }
  return bytes;
}

// Reads all rows of an element: row(values, lists) with one value for each property, and the items of its
// list property `wanted`.
template <class Row>
void read_rows(Values& values, const Element& element, const Property* wanted, const Complaint& complaint,
               Progress& progress, const Row& row) {
  constexpr std::size_t kRowsPerCheck = 1 << 14;
  if (element.properties.empty()) return;
  const std::size_t least = least_bytes(element, values.ascii());
  if (element.count > (values.left() + 1) / least) complaint.truncated(element, values.left() / least);
  std::vector<double> scalars(element.properties.size());
  std::vector<std::int32_t> items;
  for (std::size_t r = 0; r < element.count; ++r) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      if (!values.next(property.list ? property.count_type : property.type, scalars[p]))
        complaint.truncated(element, r);
      if (!property.list) continue;
      const double count = scalars[p];
      if (!(count >= 0 && count <= static_cast<double>(values.left()))) {
        if (count >= 0) complaint.truncated(element, r);
        complaint.damaged(
            {"a list of element '", element.name, "' ", std::to_string(r), " has a negative length"});
      }
      const bool keep = &property == wanted;
      if (keep) items.clear();
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        double item = 0;
        if (!values.next(property.type, item)) complaint.truncated(element, r);
        // What is no index becomes -1, which later checks name together with its face.
        const bool index = item >= 0 && item <= std::numeric_limits<std::int32_t>::max();
        if (keep) items.push_back(index ? static_cast<std::int32_t>(item) : -1);
      }
    }
    row(scalars, items);
    if (r % kRowsPerCheck == 0) progress.check();
  }
}

// Scalar properties that are kept as attributes, with their columns.
struct Kept {
  std::vector<std::size_t> columns;
  std::vector<TinAttribute> attributes;

  void add(std::size_t column, const Property& property, std::size_t count) {
    columns.push_back(column);
    attributes.push_back({property.name, {}});
    attributes.back().values.reserve(count);
  }
  void push(const std::vector<double>& scalars) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      attributes[i].values.push_back(static_cast<float>(scalars[columns[i]]));
  }
};

void read_vertices(Values& values, const Element& element, Tin& tin, const Complaint& complaint,
                   Progress& progress) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::array<std::size_t, 3> xyz{kNone, kNone, kNone};
  std::size_t sigma = kNone;
  Kept kept;
  if (element.count > (values.left() + 1) / std::max<std::size_t>(1, least_bytes(element, values.ascii()))) {
    complaint.truncated(element, 0);
  }
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const Property& property = element.properties[p];
    if (property.list) continue;
    if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
      xyz[static_cast<std::size_t>(property.name[0] - 'x')] = p;
    } else if (property.name == "sigma_v") {
      sigma = p;
    } else {
      kept.add(p, property, element.count);
    }
  }
  if (std::count(xyz.begin(), xyz.end(), kNone) > 0) complaint.damaged({"its vertices lack x, y or z"});
  tin.vertices.reserve(element.count);
  read_rows(values, element, nullptr, complaint, progress, [&](const std::vector<double>& row, const auto&) {
    tin.vertices.push_back({row[xyz[0]], row[xyz[1]], row[xyz[2]]});
    if (sigma != kNone) tin.sigma_v.push_back(static_cast<float>(row[sigma]));
    kept.push(row);
  });
  tin.vertex_attributes = std::move(kept.attributes);
}

struct RawFaces {
  std::vector<std::int32_t> corners;
  std::vector<std::size_t> ends;
  Kept kept;
};

RawFaces read_faces(Values& values, const Element& element, const Complaint& complaint, Progress& progress) {
  RawFaces faces;
  const Property* corners = nullptr;
  if (element.count > (values.left() + 1) / std::max<std::size_t>(1, least_bytes(element, values.ascii()))) {
    complaint.truncated(element, 0);
  }
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const Property& property = element.properties[p];
    if (property.list && (property.name == "vertex_indices" || property.name == "vertex_index"))
      corners = &property;
    if (!property.list) faces.kept.add(p, property, element.count);
  }
  if (corners == nullptr && element.count > 0) complaint.damaged({"its faces lack the list vertex_indices"});
  read_rows(values, element, corners, complaint, progress,
            [&](const std::vector<double>& row, const std::vector<std::int32_t>& items) {
              faces.corners.insert(faces.corners.end(), items.begin(), items.end());
              faces.ends.push_back(faces.corners.size());
              faces.kept.push(row);
            });
  return faces;
}

}  // namespace

TinSource parse_ply(std::string_view bytes, const std::string& what, Progress& progress) {
  const Complaint complaint(what);
  std::string_view rest = bytes;
  const Header header = read_header(rest, complaint);
  Values values(rest, header, complaint);
  TinSource source;
  source.crs = header.crs;
  RawFaces faces;  // may come before the vertices
  bool vertices_seen = false, faces_seen = false;
  for (const Element& element : header.elements) {
    if (element.name == "vertex" && !std::exchange(vertices_seen, true)) {
      read_vertices(values, element, source.tin, complaint, progress);
    } else if (element.name == "face" && !std::exchange(faces_seen, true)) {
      faces = read_faces(values, element, complaint, progress);
    } else {
      read_rows(values, element, nullptr, complaint, progress, [](const auto&, const auto&) {});
    }
  }
  FaceCollector collector(source.tin, what);
  source.tin.faces.reserve(faces.ends.size());
  std::size_t begin = 0;
  for (const std::size_t end : faces.ends) {
    collector.add({faces.corners.data() + begin, end - begin});
    begin = end;
  }
  collector.finish(std::move(faces.kept.attributes));
  return source;
}

}  // namespace sightbound
