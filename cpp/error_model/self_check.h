// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM predicts its own samples: every other one is kept, the error between those is estimated from them as
// it would be for a DEM of that spacing, and the samples left out tell how large it is.
#pragma once

#include <cstddef>
#include <vector>

#include "base/progress.h"
#include "error_model/step_law.h"
#include "error_model/tails.h"
#include "terrain/grid.h"

namespace sightbound {

class SelfCheck {
 public:
  // `exponent`: of the residuals' growth from spacing 2 to 4; `typical_m`: see local_variation.
  SelfCheck(double exponent, double typical_m);

  void add(const Grid<float>& block, Progress&);
  // After the last block.
  void finish();

  std::size_t places() const { return places_; }
  // Within +- this many predicted standard deviations lies a share of the errors; 0 without places.
  double quantile(double share) const;
  // How the variance of the errors depends on the step between the samples that they lie between. What
  // follows takes it as given.
  StepLaw steps() const { return steps_; }
  // The distribution whose quantile of 99 % over that of 68.3 % is nearest.
  Tails tails() const;
  // What the predicted sd had to be multiplied by for 95 % to hold, half the way taken (its root: the next
  // octave of terrain is another one), 0.6 to 1.7.
  double scale() const;

 private:
  void count(double error, double half_step, double sd);

  double exponent_, typical_m_;
  std::size_t places_ = 0;
  StepLaw steps_;
  std::vector<std::size_t> by_step_;    // of errors over sd, class by class of steps
  std::vector<std::size_t> histogram_;  // of errors over what steps_ leaves of it
};

}  // namespace sightbound
