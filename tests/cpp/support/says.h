// SPDX-License-Identifier: GPL-3.0-or-later
// What messages say.
#pragma once

#include <exception>
#include <string>

#include <gtest/gtest.h>

namespace sightbound::testing {

// EXPECT_TRUE(says(text, "part of it")) prints the text when it is not there.
inline ::testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no '" << part << "' in '" << text << "'";
}

// What f() complains about.
template <class E, class F>
std::string complaint(F f) {
  try {
    f();
  } catch (const E& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another kind of error: ") + error.what();
  }
  return "no error";
}

}  // namespace sightbound::testing
