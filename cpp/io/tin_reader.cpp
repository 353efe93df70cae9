// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/tin_reader.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string_view>

#include <cpl_vsi.h>

#include "base/error.h"
#include "base/memory_budget.h"
#include "io/gdal_support.h"
#include "io/tin_formats.h"
#include "io/tin_text.h"

namespace sightbound {

namespace {

enum class Format { kPly, kObj, k2dm, kLandXml, kVector };

struct FileClose {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using File = std::unique_ptr<VSILFILE, FileClose>;

// Nothing when it cannot be opened as a file: a folder, a database.
File open_file(const std::string& path) {
  const gdal::ErrorLog log;
  VSIStatBufL status;
  if (VSIStatL(path.c_str(), &status) != 0 || VSI_ISDIR(status.st_mode)) return {};
  return File(VSIFOpenL(path.c_str(), "rb"));
}

bool ends_with(const std::string& path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  return std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

Format format_of(VSILFILE* file, const std::string& path) {
  if (file == nullptr) return Format::kVector;
  std::array<char, 4096> head{};
  const std::size_t read = VSIFReadL(head.data(), 1, head.size(), file);
  std::string_view start(head.data(), read);
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return Format::kPly;
  if (start.starts_with("MESH2D")) return Format::k2dm;
  if (start.find("<LandXML") != std::string_view::npos) return Format::kLandXml;
  // Files that say nothing at their start, or are damaged there, go by their names.
  if (ends_with(path, ".obj")) return Format::kObj;
  if (ends_with(path, ".ply")) return Format::kPly;
  if (ends_with(path, ".2dm")) return Format::k2dm;
  return Format::kVector;
}

std::string read_bytes(VSILFILE* file, const std::string& what, Progress& progress) {
  constexpr std::size_t kChunk = 1 << 24;
  const gdal::ErrorLog log;
  VSIFSeekL(file, 0, SEEK_END);
  const auto size = static_cast<std::size_t>(VSIFTellL(file));
  VSIFSeekL(file, 0, SEEK_SET);
  MemoryBudget().require(3 * size, what, "Give a part of it.");
  std::string bytes(size, '\0');
  for (std::size_t done = 0; done < size;) {
    const std::size_t read = VSIFReadL(bytes.data() + done, 1, std::min(kChunk, size - done), file);
    if (read == 0) throw IoError(what + " cannot be read to its end: " + log.message());
    done += read;
    progress.check();
  }
  return bytes;
}

}  // namespace

Tin read_tin(const std::string& path, const TinReadOptions& options, Progress& progress) {
  if (path.empty()) throw InvalidInput("The TIN: the path is empty; name a file.");
  const std::string what = "The TIN '" + path + "'";
  const File file = open_file(path);
  const Format format = format_of(file.get(), path);
  if (format == Format::kVector)
    return make_tin(read_vector_tin(path, options, what, progress), options, what, progress);
  if (format != Format::kLandXml && !options.layers.empty()) {
    throw InvalidInput(what + " holds one mesh, which has no name: leave out layer ('" +
                       options.layers.front() + "').");
  }
  const auto source = [&] {
    const std::string bytes = read_bytes(file.get(), what, progress);
    switch (format) {
      case Format::kPly:
        return parse_ply(bytes, what, progress);
      case Format::kObj:
        return parse_obj(bytes, what, progress);
      case Format::k2dm:
        return parse_2dm(bytes, what, progress);
      default:
        return parse_landxml(bytes, options.layers, what, progress);
    }
  };
  return make_tin(source(), options, what, progress);
}

std::vector<std::string> tin_layers(const std::string& path, Progress& progress) {
  if (path.empty()) throw InvalidInput("The TIN: the path is empty; name a file.");
  const std::string what = "The TIN '" + path + "'";
  const File file = open_file(path);
  switch (format_of(file.get(), path)) {
    case Format::kVector:
      return vector_layers(path);
    case Format::kLandXml:
      return landxml_surfaces(read_bytes(file.get(), what, progress), what, progress);
    default:
      return {};
  }
}

}  // namespace sightbound
