#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::testing {

/// A model that comes with mjarm, which has to load.
inline Model shipped(std::string_view name) {
  const auto file = find_model_file(name);
  EXPECT_TRUE(file) << (file ? "" : file.error().what);
  auto model = Model::load(*file);
  EXPECT_TRUE(model) << (model ? "" : model.error().what);
  return *model;
}

/// A model and its arm, for tests.
struct TestArm {
  Model model;
  Arm arm;
};

/// A shipped model and its arm.
inline TestArm shipped_arm(std::string_view name) {
  Model model = shipped(name);
  auto arm = find_arm(model);
  EXPECT_TRUE(arm) << (arm ? "" : arm.error().what);
  return {std::move(model), std::move(*arm)};
}

}  // namespace mjarm::testing
