// SPDX-License-Identifier: GPL-3.0-or-later
// Places of one CRS in another.
#pragma once

#include <memory>
#include <span>
#include <string>

namespace sightbound {

// x = east (or longitude), y = north in both; horizontal parts only. Where one CRS is missing or both are the
// same, places stay as they are. Serves one thread at a time.
class CrsCrossing {
 public:
  // `what` begins the message ("The check points"). Throws InvalidInput when there is no way between them.
  CrsCrossing(const std::string& from_wkt, const std::string& to_wkt, const std::string& what);
  ~CrsCrossing();
  CrsCrossing(CrsCrossing&&) noexcept;

  bool is_identity() const { return !way_; }
  // In place; a place that cannot be transformed becomes infinite.
  void apply(std::span<double> x, std::span<double> y) const;

 private:
  struct Way;
  std::unique_ptr<Way> way_;
};

}  // namespace sightbound
