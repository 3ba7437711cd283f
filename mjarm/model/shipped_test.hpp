#pragma once

#include <gtest/gtest.h>

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

}  // namespace mjarm::testing
