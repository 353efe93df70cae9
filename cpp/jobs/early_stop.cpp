// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/early_stop.h"

#include <algorithm>
#include <cmath>

#include "error_model/error_model.h"
#include "error_model/verdict.h"
#include "sight/draws.h"

namespace sightbound {

namespace {

constexpr double kDoubt = 0.05;  // of all intervals together

int whole_sixteens(double realisations) {
  return static_cast<int>(std::ceil(realisations / kLanes)) * kLanes;
}

// For a cell that was always seen Wilson's lower end is n / (n + z^2).
int first_look(double confidence, double z) {
  return whole_sixteens(std::min(z * z * (1 + confidence) / (1 - confidence), 1e6));
}

}  // namespace

ShareInterval wilson(double share, double n, double z) {
  const double z2 = z * z, middle = share + z2 / (2 * n);
  const double half = z * std::sqrt((share * (1 - share) + z2 / (4 * n)) / n), all = 1 + z2 / n;
  return {(middle - half) / all, (middle + half) / all};
}

EarlyStop::EarlyStop(int most, double confidence, double precision)
    : hidden_((1 - confidence) / 2), visible_((1 + confidence) / 2), precision_(precision) {
  // The first of endlessly many looks may err in 6 / pi^2 of the doubt.
  const double widest = two_sided_quantile(1 - kDoubt * 6 / (M_PI * M_PI));
  double share = 0;
  if (precision > 0) {
    for (int n = first_look(confidence, widest); n < most; n *= 2) looks_.push_back({n, 0});
  }
  looks_.push_back({most, 0});
  for (std::size_t k = 1; k <= looks_.size(); ++k) share += 1.0 / static_cast<double>(k * k);
  for (std::size_t k = 1; k <= looks_.size(); ++k)
    looks_[k - 1].z = two_sided_quantile(1 - kDoubt / (static_cast<double>(k * k) * share));
}

bool EarlyStop::is_settled(double p, const Look& look) const {
  const ShareInterval known = wilson(p, look.realisations, look.z);
  if (known.high - known.low > 2 * precision_) return false;
  const bool between = known.low > hidden_ && known.high < visible_;
  return between || known.high <= hidden_ || known.low >= visible_;
}

unsigned char EarlyStop::claim(double p, const Look& look) const {
  const ShareInterval known = wilson(p, look.realisations, look.z);
  if (known.low >= visible_) return kVisible;
  return known.high <= hidden_ ? kHidden : kUncertain;
}

const Look& EarlyStop::look_at(int realisations) const {
  return *std::ranges::find(looks_, realisations, &Look::realisations);
}

}  // namespace sightbound
