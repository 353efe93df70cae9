// SPDX-License-Identifier: GPL-3.0-or-later
// Which GDAL this library was compiled for, and which one the process has loaded.
#pragma once

#include <string>

namespace sightbound {

struct GdalVersions {
  std::string compiled;  // of the headers, e.g. "3.6.2"
  std::string loaded;    // of the library that answers
};
GdalVersions gdal_versions();

}  // namespace sightbound
