// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/tin_target.h"

#include <cmath>

#include "base/error.h"
#include "base/number_text.h"
#include "io/tin_writer.h"

namespace sightbound {

SimplifyOptions::Bytes bytes_for(const TinTarget& target, const Tin& like) {
  if (target.bytes == 0) return {};
  const TinFileSize size = tin_file_size(target.ending, like);
  const double most = target.bytes - size.fixed;
  if (!(most > 0) || !std::isfinite(most)) {
    throw InvalidInput("target_bytes is " + number_text(target.bytes) + "; a file that ends in '" +
                       target.ending + "' takes more than " + number_text(size.fixed) + " bytes.");
  }
  return {most, size.of_vertex, size.of_face};
}

void say_what_is_missed(const TinTarget& target, const SimplifyOptions::Bytes& bytes, const Tin& made,
                        std::vector<std::string>& warnings) {
  const std::string why = ": nothing more can be removed (tolerance, vertices and lines to keep).";
  const auto faces = static_cast<std::int64_t>(made.faces.size());
  if (target.faces > 0 && faces > target.faces + 1) {
    warnings.push_back("target_faces is " + std::to_string(target.faces) + ", but " + std::to_string(faces) +
                       " are left" + why);
  }
  const double taken = bytes.of_vertex * static_cast<double>(made.vertices.size()) +
                       bytes.of_face * static_cast<double>(made.faces.size());
  if (target.bytes > 0 && taken > bytes.most) {
    warnings.push_back("The file will have some " + number_text(taken - bytes.most) +
                       " bytes more than target_bytes" + why);
  }
}

}  // namespace sightbound
