// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/whole_file.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include <cpl_vsi.h>

#include "base/error.h"
#include "io/gdal_support.h"

namespace sightbound {

namespace {

namespace fs = std::filesystem;

// Paths of GDAL's virtual file systems (/vsimem/ ...) mean nothing to the operating system.
bool is_virtual(const std::string& path) { return path.starts_with("/vsi"); }

fs::path native(const std::string& utf8) { return fs::path(std::u8string(utf8.begin(), utf8.end())); }

std::string random_name() {
  std::random_device device;
  std::array<char, 20> text{};
  std::snprintf(text.data(), text.size(), "%08x%08x", static_cast<unsigned>(device()),
                static_cast<unsigned>(device()));
  return text.data();
}

void remove_quietly(const std::string& path) {
  const gdal::ErrorLog log;
  VSIUnlink(path.c_str());
}

bool exists(const std::string& path) {
  VSIStatBufL status;
  return VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0;
}

void rename_over(const std::string& from, const std::string& to) {
  std::string reason;
  if (is_virtual(to)) {
    if (VSIRename(from.c_str(), to.c_str()) == 0) return;
    reason = std::strerror(errno);
  } else {
    std::error_code failed;
    fs::rename(native(from), native(to), failed);  // replaces on every platform
    if (!failed) return;
    reason = failed.message();
  }
  throw IoError("'" + to + "' cannot be put in place: " + reason + ".");
}

}  // namespace

WholeFile::WholeFile(std::string target) : target_(std::move(target)) {
  if (target_.empty()) throw InvalidInput("The output path is empty; name a file.");
  const std::size_t slash = target_.find_last_of("/\\");
  const std::string folder = slash == std::string::npos ? "" : target_.substr(0, slash + 1);
  const std::string name = slash == std::string::npos ? target_ : target_.substr(slash + 1);
  if (!is_virtual(target_)) {
    std::error_code ignored;
    if (!folder.empty() && !fs::is_directory(native(folder), ignored)) {
      throw IoError("'" + target_ + "' cannot be written: the folder '" + folder + "' does not exist.");
    }
    if (fs::is_directory(native(target_), ignored)) {
      throw IoError("'" + target_ + "' cannot be written: it is a folder; name a file.");
    }
  }
  temporary_ = folder + "." + name + "." + random_name() + ".part";
}

WholeFile::~WholeFile() {
  if (kept_) return;
  remove_quietly(temporary_);
  remove_quietly(temporary_ + ".aux.xml");
}

void WholeFile::keep() {
  for (const char* side : {".aux.xml", ".ovr", ".msk"}) {
    if (exists(target_ + side)) remove_quietly(target_ + side);
  }
  rename_over(temporary_, target_);
  kept_ = true;
  if (exists(temporary_ + ".aux.xml")) rename_over(temporary_ + ".aux.xml", target_ + ".aux.xml");
}

}  // namespace sightbound
