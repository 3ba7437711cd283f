#pragma once

#include <span>

#include "apps/mjarm/learn/exercise.hpp"
#include "mjarm/core/messages.hpp"

namespace mjarm::app {

/// One page of the learning path.
struct LearnPage {
  const char* name;  ///< of its file, without ending and language
  Msg title;
  Msg about;         ///< one line: what it is about
  const char* file;  ///< what its exercise makes; empty where nothing has to be there
  Msg how;           ///< how the reader gets there
  LearnCheck* check;
};

/// All pages in their order: the first is page 1.
[[nodiscard]] std::span<const LearnPage> learn_pages();

}  // namespace mjarm::app
