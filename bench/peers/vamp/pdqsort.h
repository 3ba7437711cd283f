#pragma once

/// VAMP sorts with pdqsort, which it fetches as it is built; Boost has the same.
#include <boost/sort/pdqsort/pdqsort.hpp>

using boost::sort::pdqsort;
using boost::sort::pdqsort_branchless;
