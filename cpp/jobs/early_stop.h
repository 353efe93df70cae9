// SPDX-License-Identifier: GPL-3.0-or-later
// When enough realisations have been drawn of a cell: an interval for its probability, looked at several
// times.
//
// Who looks often is sooner deceived. So the doubt of 5 % is split over the looks, in proportion to 1 / k^2
// for the k-th: the intervals of all looks hold together with 95 %. The first look is where a cell that was
// seen always, or never, can be claimed at the confidence; each other after twice as many realisations.
#pragma once

#include <vector>

namespace sightbound {

// Wilson's interval (1927) for a share of `n`, for z standard deviations.
struct ShareInterval {
  double low, high;
};
ShareInterval wilson(double share, double n, double z);

struct Look {
  int realisations;  // so far
  double z;          // quantile of its interval
};

class EarlyStop {
 public:
  // `precision`: half the width of an interval that will do, 0..0.5; 0 = draw all `most`.
  EarlyStop(int most, double confidence, double precision);

  const std::vector<Look>& looks() const { return looks_; }
  // The interval is narrow enough, and wholly on one side of what separates the claims.
  bool is_settled(double share, const Look&) const;
  // kVisible when all of the interval is (1 + c) / 2 or more, kHidden when it is (1 - c) / 2 or less.
  unsigned char claim(double share, const Look&) const;
  const Look& look_at(int realisations) const;

 private:
  double hidden_, visible_, precision_;
  std::vector<Look> looks_;
};

}  // namespace sightbound
