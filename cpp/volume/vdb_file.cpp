// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/vdb_file.h"

#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "volume/vdb.h"

namespace sightbound {

namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 8> kMark{'s', 'i', 'g', 'h', 't', 'v', 'd', 'b'};
constexpr std::uint64_t kTrailer = 24;
constexpr std::array<char, 4> kVdbMagic{' ', 'B', 'D', 'V'};  // 0x56444220, low byte first
// The identifier: 36 characters behind magic (8), three versions (4 each) and a flag (1).
constexpr std::uint64_t kIdentifierAt = 21;
constexpr std::array<int, 4> kDashes{8, 13, 18, 23};

fs::path native(const std::string& utf8) { return fs::path(std::u8string(utf8.begin(), utf8.end())); }

// Of all bytes but the identifier's, which is made from it. 64 bits: damage by chance, not by intent.
class Checksum {
 public:
  void add(const char* bytes, std::size_t count) {  // count is a multiple of 8 but for the last call
    while (count >= 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, 8);
      mix(word);
      bytes += 8;
      count -= 8;
    }
    std::uint64_t rest = count;
    std::memcpy(reinterpret_cast<char*>(&rest) + 1, bytes, count);
    if (count > 0) mix(rest);
  }
  std::uint64_t value() const { return state_ ^ (state_ >> 29); }

 private:
  void mix(std::uint64_t word) { state_ = std::rotl(state_ ^ word, 27) * 0x9e3779b97f4a7c15u + 0x52dce729u; }
  std::uint64_t state_ = 0x2545f4914f6cdd1du;
};

std::uint64_t checksum_of(std::istream& in, std::uint64_t size) {
  std::vector<char> buffer(std::size_t{1} << 20);
  Checksum sum;
  in.seekg(0);
  for (std::uint64_t done = 0; done < size;) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(buffer.size(), size - done));
    in.read(buffer.data(), static_cast<std::streamsize>(part));
    if (!in) return 0;
    if (done == 0 && part >= kIdentifierAt + 36) std::memset(buffer.data() + kIdentifierAt, '0', 36);
    sum.add(buffer.data(), part);
    done += part;
  }
  return sum.value();
}

std::array<char, 8> bytes_of(std::uint64_t value) {
  std::array<char, 8> out{};
  for (std::size_t i = 0; i < 8; ++i) out[i] = static_cast<char>(value >> (8 * i) & 0xff);
  return out;
}

std::uint64_t value_of(const char* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return value;
}

// Looks like any other identifier (8-4-4-4-12 hexadecimal digits, version 4).
std::string identifier_from(std::uint64_t sum) {
  char text[40];
  std::snprintf(text, sizeof(text), "%08x-%04x-4%03x-8%03x-%012llx", static_cast<unsigned>(sum >> 32),
                static_cast<unsigned>(sum >> 16 & 0xffff), static_cast<unsigned>(sum >> 4 & 0xfff),
                static_cast<unsigned>(sum & 0xfff), static_cast<unsigned long long>(sum & 0xffffffffffffu));
  return text;
}

// Puts identifier and trailer onto what OpenVDB has written.
void seal(const fs::path& path) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(file.tellg());
  std::array<char, 36> found{};
  file.seekg(kIdentifierAt);
  file.read(found.data(), found.size());
  for (const int dash : kDashes) {
    if (!file || found[static_cast<std::size_t>(dash)] != '-')
      throw BrokenGuarantee("OpenVDB's file has its identifier elsewhere.");
  }
  const std::uint64_t sum = checksum_of(file, size);
  const std::string identifier = identifier_from(sum);
  file.seekp(kIdentifierAt);
  file.write(identifier.data(), 36);
  file.seekp(0, std::ios::end);
  for (const auto& part : {kMark, bytes_of(size), bytes_of(sum)}) file.write(part.data(), part.size());
  file.close();
  if (!file) throw IoError("'" + path.string() + "' cannot be written: " + std::strerror(errno) + ".");
}

// A hidden file beside the target; removed unless renamed.
class Part {
 public:
  explicit Part(const std::string& target) : target_(native(target)) {
    if (target.empty()) throw InvalidInput("The output path is empty; name a file.");
    std::error_code ignored;
    const fs::path folder = target_.parent_path();
    if (!folder.empty() && !fs::is_directory(folder, ignored)) {
      throw IoError("'" + target + "' cannot be written: the folder '" + folder.string() +
                    "' does not exist.");
    }
    if (fs::is_directory(target_, ignored)) {
      throw IoError("'" + target + "' cannot be written: it is a folder; name a file.");
    }
    std::random_device device;
    char unique[20];
    std::snprintf(unique, sizeof(unique), "%08x%08x", static_cast<unsigned>(device()),
                  static_cast<unsigned>(device()));
    path_ = folder / ("." + target_.filename().string() + "." + unique + ".part");
  }
  ~Part() {
    std::error_code ignored;
    if (!kept_) fs::remove(path_, ignored);
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  const fs::path& path() const { return path_; }
  void keep() {
    std::error_code failed;
    fs::rename(path_, target_, failed);
    if (failed) throw IoError("'" + target_.string() + "' cannot be put in place: " + failed.message() + ".");
    kept_ = true;
  }

 private:
  fs::path target_, path_;
  bool kept_ = false;
};

// Throws unless the file is one of ours, whole and unchanged.
void require_sound(const std::string& path, const std::string& what) {
  std::ifstream file(native(path), std::ios::binary);
  if (!file) throw IoError("'" + path + "' cannot be opened: " + std::strerror(errno) + ".");
  std::array<char, 4> magic{};
  file.read(magic.data(), magic.size());
  if (!file || magic != kVdbMagic) refuse_vdb(path, what, "it is no .vdb file");
  file.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(file.tellg());
  std::array<char, kTrailer> trailer{};
  if (size > kTrailer) {
    file.seekg(static_cast<std::streamoff>(size - kTrailer));
    file.read(trailer.data(), trailer.size());
  }
  if (!file || std::memcmp(trailer.data(), kMark.data(), kMark.size()) != 0) {
    refuse_vdb(path, what,
               "another program wrote it, or its end is missing; take the file that Sightbound wrote");
  }
  if (value_of(trailer.data() + 8) != size - kTrailer ||
      value_of(trailer.data() + 16) != checksum_of(file, size - kTrailer)) {
    throw IoError("'" + path + "' is damaged: its checksum is wrong. Make it again.");
  }
}

}  // namespace

void refuse_vdb(const std::string& path, const std::string& what, const std::string& why) {
  throw InvalidInput("'" + path + "' is not " + what + " of Sightbound: " + why + ".");
}

void write_vdb(const std::string& path, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
  initialize_vdb();
  Part part(path);
  try {
    openvdb::io::File file(part.path().string());
    file.write(grids, metadata);
    file.close();
  } catch (const openvdb::Exception& error) {
    throw IoError("'" + path + "' cannot be written: " + error.what() + ".");
  }
  seal(part.path());
  part.keep();
}

VdbContent read_vdb(const std::string& path, const std::string& what) {
  initialize_vdb();
  require_sound(path, what);
  VdbContent content;
  try {
    openvdb::io::File file(path);
    file.open(/*delayLoad=*/false);
    content.metadata = *file.getMetadata();
    content.grids = *file.getGrids();
    file.close();
  } catch (const openvdb::Exception& error) {
    throw IoError("'" + path + "' cannot be read: " + error.what() + ".");
  }
  return content;
}

}  // namespace sightbound
