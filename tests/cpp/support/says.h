// SPDX-License-Identifier: GPL-3.0-or-later
// What messages say.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace sightbound::testing {

// EXPECT_TRUE(says(text, "part of it")) prints the text when it is not there.
inline ::testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no '" << part << "' in '" << text << "'";
}

}  // namespace sightbound::testing
