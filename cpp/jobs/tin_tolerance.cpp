// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/tin_tolerance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

// A tolerance stands for z(c) sigma: any c would do. With this one the least sigma that volumes know
// (kLeastSigma) stands for less than a micrometre, so that no tolerance is raised to it.
constexpr double kConfidenceOfTolerances = 0.0007;

bool is_tolerance(double metres) { return metres >= 0 && metres <= kLargestError; }

float rounded_down(double value) { return std::nextafter(static_cast<float>(value), 0.0F); }

std::vector<float> given_tolerances(const Tin& tin, const SimplifyTinJob& job) {
  if (job.tolerance_m) {
    if (is_tolerance(*job.tolerance_m))
      return std::vector<float>(tin.vertices.size(), rounded_down(*job.tolerance_m));
    throw InvalidInput("tolerance is " + number_text(*job.tolerance_m) + "; give metres, 0 to " +
                       number_text(kLargestError) + ".");
  }
  std::vector<float> metres = job.tolerances_m;
  if (metres.size() != tin.vertices.size()) {
    throw InvalidInput("tolerance has " + std::to_string(metres.size()) + " values, the TIN " +
                       std::to_string(tin.vertices.size()) + " vertices; give one for each.");
  }
  const auto wrong = [](float value) { return !is_tolerance(static_cast<double>(value)); };
  if (const auto bad = std::find_if(metres.begin(), metres.end(), wrong); bad != metres.end()) {
    throw InvalidInput("tolerance is " + number_text(static_cast<double>(*bad), 6) + " at vertex " +
                       std::to_string(bad - metres.begin()) + " (" +
                       std::to_string(std::count_if(bad, metres.end(), wrong)) + " such of " +
                       std::to_string(metres.size()) + "); give metres, 0 to " + number_text(kLargestError) +
                       ", for every vertex.");
  }
  for (float& value : metres) value = rounded_down(static_cast<double>(value));
  return metres;
}

TinTolerance of_tolerances(const Tin& tin, const SimplifyTinJob& job) {
  TinTolerance result;
  result.metres = given_tolerances(tin, job);
  result.confidence = kConfidenceOfTolerances;
  const double z = two_sided_quantile(result.confidence);
  result.error.spacing_m = median_edge(tin);
  result.error.sampling.reserve(result.metres.size());
  for (const float metres : result.metres)
    result.error.sampling.push_back(rounded_down(static_cast<double>(metres) / z));
  const std::vector<float>& told = job.tolerance_m ? result.metres : job.tolerances_m;
  const auto [least, largest] = std::minmax_element(told.begin(), told.end());
  result.least = job.tolerance_m.value_or(static_cast<double>(*least));
  result.largest = job.tolerance_m.value_or(static_cast<double>(*largest));
  return result;
}

}  // namespace

// sigma of the samples alone is linear and never more than sigma: the metres may go to that.
TinTolerance tolerance_of(const Tin& tin, const SimplifyTinJob& job, Metric metric) {
  if (job.tolerance_m || !job.tolerances_m.empty()) return of_tolerances(tin, job);
  TinTolerance result;
  result.error = resolve_tin_error(tin, job.model, metric);
  result.confidence = job.confidence;
  result.tails = job.model.tails_used();
  const double z = two_sided_quantile(job.confidence, result.tails);
  result.least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < result.error.sampling.size(); ++v) {
    const double sigma = static_cast<double>(result.error.sampling[v]);
    const double between =
        result.error.amplitude.empty() ? 0 : static_cast<double>(result.error.amplitude[v]);
    result.metres.push_back(rounded_down(z * sigma));
    result.least = std::min(result.least, z * sigma);
    result.largest = std::max(result.largest, z * std::max(sigma + between, kLeastSigma));
  }
  return result;
}

}  // namespace sightbound
