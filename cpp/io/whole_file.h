// SPDX-License-Identifier: GPL-3.0-or-later
// A file that appears under its name only when whole. Internal to cpp/io.
#pragma once

#include <string>

namespace sightbound {

// Names a hidden file in the target's folder; the destructor removes it unless it was kept. GDAL's side files
// (.aux.xml) go the same way; those of a file replaced are removed, they describe something else.
class WholeFile {
 public:
  // Throws IoError when the folder is missing or the target is a folder.
  explicit WholeFile(std::string target);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  const std::string& temporary() const { return temporary_; }
  // Renames over the target. Throws IoError.
  void keep();

 private:
  std::string target_, temporary_;
  bool kept_ = false;
};

}  // namespace sightbound
