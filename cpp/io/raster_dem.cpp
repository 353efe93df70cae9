// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/raster_dem.h"

#include <chrono>
#include <mutex>
#include <thread>
#include <utility>

#include "base/error.h"
#include "io/band_reader.h"
#include "io/crs.h"
#include "io/gdal_support.h"
#include "io/vertical_unit.h"

namespace sightbound {

namespace {

constexpr const char* kWhat = "The DEM";

class RasterDem final : public DemSource {
 public:
  RasterDem(GDALDatasetUniquePtr dataset, Band band, const Geotransform& geotransform, std::string crs_wkt,
            std::vector<std::string> notes)
      : DemSource(dataset->GetRasterYSize(), dataset->GetRasterXSize(), geotransform, std::move(crs_wkt)),
        dataset_(std::move(dataset)),
        band_(std::move(band)) {
    for (std::string& note : notes) add_note(std::move(note));
  }

  Grid<float> read(const Window& wanted, Progress& progress) const override {
    if (!window().contains(wanted)) throw BrokenGuarantee("a window outside the DEM was asked for");
    Window in_file = wanted;
    if (flipped()) in_file.row = rows() - wanted.row_end();
    const std::unique_lock reading = wait_for_turn(progress);
    BandValues read = read_band(band_, in_file, flipped(), progress);
    note(read.counts);
    return std::move(read.values);
  }

 private:
  // A DEM may be read in several windows that overlap: the largest count of one window is what is surely
  // true.
  void note(const DecodingCounts& counts) const {
    if (counts.spikes > most_.spikes) {
      most_.spikes = counts.spikes;
      set_note(spike_note_,
               "At least " + std::to_string(counts.spikes) + " samples lie beyond " +
                   std::to_string(static_cast<int>(kLargestHeight)) +
                   " m and were taken as holes; declare them as nodata, or check the vertical unit.");
    }
    if (counts.usual_marks > most_.usual_marks) {
      most_.usual_marks = counts.usual_marks;
      set_note(mark_note_,
               "At least " + std::to_string(counts.usual_marks) +
                   " samples are exactly -9999 and the raster declares no nodata: they were taken as "
                   "heights. Declare -9999 as nodata if they are holes.");
    }
  }

  void set_note(std::size_t& place, std::string text) const {
    if (place == kNoPlace) {
      place = add_note(std::move(text));
    } else {
      change_note(place, std::move(text));
    }
  }

  // GDAL's handles serve one thread at a time. Whoever waits for another job's reading can still be
  // cancelled.
  std::unique_lock<std::recursive_mutex> wait_for_turn(Progress& progress) const {
    std::unique_lock turn(one_reader_, std::try_to_lock);
    while (!turn.owns_lock() && !turn.try_lock()) {
      progress.check();
      std::this_thread::sleep_for(kTurnInterval);
    }
    return turn;
  }

  static constexpr std::chrono::milliseconds kTurnInterval{2};
  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);

  GDALDatasetUniquePtr dataset_;
  Band band_;
  mutable std::recursive_mutex one_reader_;  // recursive: a progress callback may look at the DEM being read
  mutable DecodingCounts most_;
  mutable std::size_t spike_note_ = kNoPlace, mark_note_ = kNoPlace;
};

}  // namespace

std::unique_ptr<DemSource> open_dem(const std::string& path, int band_number, VerticalUnit unit) {
  GDALDatasetUniquePtr dataset = gdal::open(path, GDAL_OF_RASTER, kWhat);
  Band band = inspect_band(*dataset, band_number, path, kWhat);
  const Geotransform geotransform(gdal::geotransform_of(*dataset, path, kWhat));
  std::string crs_wkt = gdal::crs_wkt_of(dataset->GetSpatialRef());

  if (crs_wkt.empty()) {
    refuse_degrees_without_crs(geotransform, dataset->GetRasterYSize(), dataset->GetRasterXSize());
  }
  const char* band_unit = dataset->GetRasterBand(band_number)->GetUnitType();
  VerticalScale scale = choose_vertical_unit(unit, crs_units(crs_wkt), band_unit != nullptr ? band_unit : "");
  band.decoder.metres_per_unit = scale.metres_per_unit;
  return std::make_unique<RasterDem>(std::move(dataset), std::move(band), geotransform, std::move(crs_wkt),
                                     std::move(scale.notes));
}

}  // namespace sightbound
