// SPDX-License-Identifier: GPL-3.0-or-later
// PLY, OBJ and 2DM: rows of numbers, gathered in a buffer.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <memory>

#include <cpl_vsi.h>

#include "base/error.h"
#include "io/gdal_support.h"
#include "io/tin_crs.h"
#include "io/tin_writers.h"

namespace sightbound {

namespace {

class Output {
 public:
  Output(const std::string& path, Progress& progress)
      : progress_(progress), file_(VSIFOpenL(path.c_str(), "wb")) {
    if (!file_)
      throw IoError("'" + path + "' cannot be written: " + log_.message("no space, or no permission."));
    buffer_.reserve(kChunk + 4096);
  }

  void text(std::string_view text) { buffer_.append(text); }
  // The shortest text that reads back as the same number, and a blank.
  template <class T>
  void number(T value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    buffer_.append(digits.data(), end);
    buffer_ += ' ';
  }
  void end_line() {
    if (!buffer_.empty() && buffer_.back() == ' ') buffer_.pop_back();
    buffer_ += '\n';
  }
  // Little-endian.
  template <class T>
  void bytes(T value) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    buffer_.append(raw.data(), raw.size());
  }
  void row_done() {
    ++rows_;
    if (buffer_.size() >= kChunk) flush();
  }
  void close() {
    flush();
    VSILFILE* file = file_.release();
    if (VSIFCloseL(file) != 0) fail();
  }

 private:
  static constexpr std::size_t kChunk = 1 << 20;

  [[noreturn]] void fail() {
    throw IoError("The TIN cannot be written: " + log_.message("the disk is full, or went away."));
  }
  void flush() {
    if (VSIFWriteL(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) fail();
    buffer_.clear();
    progress_.advance(static_cast<double>(rows_));
    rows_ = 0;
  }

  struct Close {
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
  };
  gdal::ErrorLog log_;
  Progress& progress_;
  std::unique_ptr<VSILFILE, Close> file_;
  std::string buffer_;
  std::size_t rows_ = 0;
};

}  // namespace

std::string ply_header(const Tin& tin, std::size_t vertices, std::size_t faces, bool ascii) {
  std::string header("ply\nformat ");
  header.append(ascii ? "ascii 1.0\n" : "binary_little_endian 1.0\n");
  if (const std::string crs = short_crs(tin.crs_wkt); !crs.empty()) header += "comment crs: " + crs + "\n";
  header += "comment z in metres\n";
  header += "element vertex " + std::to_string(vertices) + "\n";
  header += "property double x\nproperty double y\nproperty double z\n";
  for (const NamedValues& one : vertex_values(tin, {"x", "y", "z"})) {
    header += "property float " + one.name + "\n";
  }
  header += "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n";
  for (const NamedValues& one : face_values(tin, {"vertex_indices"})) {
    header += "property float " + one.name + "\n";
  }
  header += "end_header\n";
  return header;
}

void write_ply(const std::string& path, const Tin& tin, bool ascii, Progress& progress) {
  const std::vector<NamedValues> of_vertices = vertex_values(tin, {"x", "y", "z"});
  const std::vector<NamedValues> of_faces = face_values(tin, {"vertex_indices"});
  Output out(path, progress);
  out.text(ply_header(tin, tin.vertices.size(), tin.faces.size(), ascii));
  for (std::size_t v = 0; v < tin.vertices.size(); ++v) {
    const Xyz p = tin.to_crs(tin.vertices[v]);
    for (const double c : {p.x, p.y, p.z}) ascii ? out.number(c) : out.bytes(c);
    for (const NamedValues& one : of_vertices)
      ascii ? out.number((*one.values)[v]) : out.bytes((*one.values)[v]);
    if (ascii) out.end_line();
    out.row_done();
  }
  for (std::size_t f = 0; f < tin.faces.size(); ++f) {
    ascii ? out.number(3) : out.bytes(std::uint8_t{3});
    for (const std::int32_t corner : tin.faces[f]) ascii ? out.number(corner) : out.bytes(corner);
    for (const NamedValues& one : of_faces)
      ascii ? out.number((*one.values)[f]) : out.bytes((*one.values)[f]);
    if (ascii) out.end_line();
    out.row_done();
  }
  out.close();
}

void write_obj(const std::string& path, const Tin& tin, Progress& progress) {
  Output out(path, progress);
  if (const std::string crs = short_crs(tin.crs_wkt); !crs.empty()) out.text("# crs: " + crs + "\n");
  for (const Xyz& v : tin.vertices) {
    const Xyz p = tin.to_crs(v);
    out.text("v ");
    for (const double c : {p.x, p.y, p.z}) out.number(c);
    out.end_line();
    out.row_done();
  }
  for (const Face& f : tin.faces) {
    out.text("f ");
    for (const std::int32_t corner : f) out.number(corner + std::int64_t{1});
    out.end_line();
    out.row_done();
  }
  out.close();
}

void write_2dm(const std::string& path, const Tin& tin, Progress& progress) {
  Output out(path, progress);
  out.text("MESH2D\n");
  for (std::size_t f = 0; f < tin.faces.size(); ++f) {
    out.text("E3T ");
    out.number(f + 1);
    for (const std::int32_t corner : tin.faces[f]) out.number(corner + std::int64_t{1});
    out.text("1");
    out.end_line();
    out.row_done();
  }
  for (std::size_t v = 0; v < tin.vertices.size(); ++v) {
    const Xyz p = tin.to_crs(tin.vertices[v]);
    out.text("ND ");
    out.number(v + 1);
    for (const double c : {p.x, p.y, p.z}) out.number(c);
    out.end_line();
    out.row_done();
  }
  out.close();
}

}  // namespace sightbound
