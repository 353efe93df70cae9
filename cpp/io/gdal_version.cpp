// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gdal_version.h"

#include <gdal.h>

namespace sightbound {

GdalVersions gdal_versions() { return {GDAL_RELEASE_NAME, GDALVersionInfo("RELEASE_NAME")}; }

}  // namespace sightbound
