// SPDX-License-Identifier: GPL-3.0-or-later
// A short, deterministic run of the fuzz entry: small meshes, mutated with fixed seeds.
#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "../../fuzz/tin_entry.h"
#include <gtest/gtest.h>

namespace sightbound {
namespace {

using fuzz::Format;

struct Seeds {
  Format format;
  std::vector<std::string> files;
};

std::string binary_ply() {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face 2\n"
      "property list uchar int vertex_indices\nproperty short n\nend_header\n";
  const std::array<float, 12> places{0, 0, 0, 8, 0, 1, 8, 8, 2, 0, 8, 3};
  bytes.append(reinterpret_cast<const char*>(places.data()), sizeof places);
  for (const std::array<std::int32_t, 3> f : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
    bytes += '\3';
    bytes.append(reinterpret_cast<const char*>(f.data()), sizeof f);
    bytes.append("\1\0", 2);
  }
  return bytes;
}

const std::vector<Seeds>& seeds() {
  static const std::vector<Seeds> all{
      {Format::kPly,
       {"ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty "
        "double y\nproperty double z\n"
        "property float sigma_v\nelement face 2\nproperty list uchar int vertex_indices\nproperty float "
        "e\nend_header\n"
        "0 0 1 .5\n10 0 2 .5\n10 10 3 .5\n0 10 4 nan\n3 0 1 2 .1\n4 0 1 2 3 .2\n",
        binary_ply()}},
      {Format::kObj,
       {"# crs: EPSG:32633\no a\nv 0 0 1\nv 10 0 2\nv 10 10 3\nv 0 10 4\nv 5 15 4\nf 1/1/1 2//2 3\nf 1 3 "
        "4\nf -1 -2 -3 2 1\n"}},
      {Format::k2dm,
       {"MESH2D\nE3T 1 1 2 3 1\nE4Q 2 1 3 4 5 2\nND 1 0 0 1\nND 2 10 0 2\nND 3 10 10 3\nND 4 0 20 4\nND 5 "
        "-10 10 4\n"
        "E6T 3 1 2 3 4 5 1 1\n"}},
      {Format::kLandXml,
       {"<?xml version=\"1.0\"?><LandXML><Units><Imperial linearUnit=\"foot\"/></Units><CoordinateSystem "
        "epsgCode=\"2263\"/><Surfaces>"
        "<Surface name=\"a\"><Definition surfType=\"TIN\"><Pnts><P id=\"1\">0 0 1</P><P id=\"2\">0 10 "
        "2</P><P id=\"3\">10 10 3</P>"
        "<P id=\"4\">10 0 3</P></Pnts><Faces><F>1 2 3</F><F i=\"1\">1 3 4</F><F>1 3 "
        "4</F></Faces></Definition></Surface></Surfaces></LandXML>"}}};
  return all;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string mutated(const std::vector<std::string>& files) {
    std::string bytes = files[below(files.size())];
    for (std::size_t steps = 1 + below(4); steps > 0 && !bytes.empty(); --steps) step(bytes, files);
    return bytes;
  }

 private:
  // Not a std distribution: those differ between libraries.
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void step(std::string& bytes, const std::vector<std::string>& files) {
    static const std::vector<std::string> kWords{
        "-1",       "0", "nan",       "inf", "1e308", "-2147483649", "4294967296", "99999999999999999999",
        "1e-320",   " ", "\n",        "<F>", "</P>",  "&lt;",        "list",       "0x10",
        "\xFF\xFE", "3", "4000000000"};
    const std::size_t at = below(bytes.size()),
                      count = 1 + below(std::min<std::size_t>(24, bytes.size() - at));
    switch (below(7)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:
        bytes.erase(at, count);
        break;
      case 3:
        bytes.insert(below(bytes.size()), bytes.substr(at, count));
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5: {  // a whole word
        const std::size_t from = bytes.find_last_of(" \n<>\"", at) + 1,
                          to = bytes.find_first_of(" \n<>\"", at);
        if (to != std::string::npos && from <= to)
          bytes.replace(from, to - from, kWords[below(kWords.size())]);
        break;
      }
      default: {
        const std::string& other = files[below(files.size())];
        bytes += other.substr(below(other.size()));
      }
    }
  }

  std::mt19937 random_;
};

TEST(TinFuzz, SeedsAreTins) {
  for (const Seeds& one : seeds()) {
    for (const std::string& file : one.files) EXPECT_TRUE(fuzz::try_tin(one.format, file)) << file;
  }
}

TEST(TinFuzz, MutatedFilesAreRefusedOrMended) {
  constexpr unsigned kRuns = 1000;
  for (const Seeds& one : seeds()) {
    unsigned made = 0;
    for (unsigned run = 0; run < kRuns; ++run) {
      const std::string bytes = Mutator(run).mutated(one.files);
      try {
        made += fuzz::try_tin(one.format, bytes);
      } catch (const std::exception& e) {
        ADD_FAILURE() << e.what() << ", format " << static_cast<int>(one.format) << ", run " << run << ":\n"
                      << bytes;
      }
    }
    // Neither always nor never: the mutations reach behind the first check.
    EXPECT_GT(made, kRuns / 50) << static_cast<int>(one.format);
    EXPECT_LT(made, kRuns - kRuns / 50) << static_cast<int>(one.format);
  }
}

}  // namespace
}  // namespace sightbound
