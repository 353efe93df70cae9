// SPDX-License-Identifier: GPL-3.0-or-later
// class -> metres from a JSON object or a CSV file (comma, semicolon or tab; a heading is recognised by
// having no number).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <system_error>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/error_rasters.h"

namespace sightbound {

namespace {

using Table = std::map<std::string, double>;

std::string trimmed(const std::string& text) {
  const char* const blank = " \t\r\n\"";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::optional<double> number(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, failed] = std::from_chars(text.data(), end, value);
  if (failed != std::errc() || stop != end || text.empty()) return {};
  return value;
}

void add(Table& table, const std::string& path, const std::string& name, double metres) {
  if (!std::isfinite(metres) || metres < 0) {
    throw InvalidInput("The terrain table '" + path + "' gives class '" + name + "' " +
                       std::to_string(metres) + "; give 0 or more metres.");
  }
  if (!table.emplace(name, metres).second) {
    throw InvalidInput("The terrain table '" + path + "' names class '" + name + "' twice.");
  }
}

Table from_json(const std::string& text, const std::string& path) {
  const nlohmann::json parsed = nlohmann::json::parse(text, nullptr, false);
  if (!parsed.is_object()) {
    throw InvalidInput("The terrain table '" + path +
                       R"(' is not a JSON object of class and metres, like {"grassland": 0.5}.)");
  }
  Table table;
  for (const auto& [name, metres] : parsed.items()) {
    if (!metres.is_number()) {
      throw InvalidInput("The terrain table '" + path + "': the value of class '" + name +
                         "' is not a number of metres.");
    }
    add(table, path, name, metres.get<double>());
  }
  return table;
}

char separator_of(const std::string& line) {
  for (const char candidate : {'\t', ';'}) {
    if (line.find(candidate) != std::string::npos) return candidate;
  }
  return ',';
}

Table from_csv(const std::string& text, const std::string& path) {
  Table table;
  int line_number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string line = text.substr(start, end - start);
    start = end + 1;
    ++line_number;
    if (trimmed(line).empty()) continue;
    const char separator = separator_of(line);
    const std::size_t cut = line.rfind(separator);
    const std::string name = cut == std::string::npos ? "" : trimmed(line.substr(0, cut));
    std::string value = cut == std::string::npos ? "" : trimmed(line.substr(cut + 1));
    if (separator != ',') std::replace(value.begin(), value.end(), ',', '.');  // decimal comma
    const std::optional<double> metres = number(value);
    if (!metres && line_number == 1 && !name.empty()) continue;  // the heading
    if (!metres || name.empty()) {
      throw InvalidInput("The terrain table '" + path + "', line " + std::to_string(line_number) +
                         ": a class and a number of metres are expected, found '" + trimmed(line) + "'.");
    }
    add(table, path, name, *metres);
  }
  return table;
}

}  // namespace

Table read_terrain_table(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError("The terrain table cannot be opened: '" + path + "'.");
  file.peek();
  if (file.bad()) throw IoError("The terrain table cannot be read: '" + path + "'.");  // a folder
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && (text[first] == '{' || text[first] == '[');
  Table table = json ? from_json(text, path) : from_csv(text, path);
  if (table.empty())
    throw InvalidInput("The terrain table '" + path + "' is empty; give classes and metres.");
  return table;
}

}  // namespace sightbound
