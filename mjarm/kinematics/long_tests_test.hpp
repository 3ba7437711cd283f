#pragma once

#include "tests/support/rounds.hpp"
