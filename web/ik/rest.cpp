// The rest of what the module is made of.
#include "mjarm/collision/exact_words.cpp"
#include "mjarm/core/cpu.cpp"
#include "mjarm/core/messages.cpp"
#include "mjarm/core/os.cpp"
#include "mjarm/core/rng.cpp"
#include "mjarm/core/rotation.cpp"
#include "mjarm/path/tool_target.cpp"
