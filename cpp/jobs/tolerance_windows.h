// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM with its error as the simplifier reads them: window by window, the error being the tolerance.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "earth/georeference.h"
#include "error_model/error_model.h"
#include "simplify/dem_windows.h"
#include "terrain/dem.h"

namespace sightbound {

class ToleranceWindows final : public DemWindows {
 public:
  // The part `window` of a DEM. The tolerance is `factor` times sigma_s of a model that is complete. `keep`,
  // on the grid of the whole DEM, may be null. All must outlive this.
  ToleranceWindows(const DemSource&, const Window& window, const ErrorModel& model, double factor,
                   const SharedGrid& keep, const Workers&);

  int rows() const override { return window_.rows; }
  int cols() const override { return window_.cols; }
  DemWindow read(const Window&, Progress&) override;

  // The one for all samples; 0 when windows bring their own.
  double constant() const { return constant_; }
  // At the samples read so far, metres.
  double least() const { return least_ < largest_ ? least_ : largest_; }
  double largest() const { return largest_; }
  // That error rasters lack values, if they do.
  std::vector<std::string> warnings() const;

 private:
  const DemSource& source_;
  const Window window_;
  ErrorModel model_;
  const Georeference georeference_;
  const double factor_;
  const SharedGrid& keep_;
  const Workers& workers_;
  double constant_ = 0;
  double least_ = std::numeric_limits<double>::infinity(), largest_ = 0;
  int rows_seen_ = 0;  // the first reading runs from above downward
  std::size_t lost_ = 0;
};

}  // namespace sightbound
