// Part of the test programs of sanitizer builds only. Graphics drivers leave a few bytes behind
// when they are unloaded; a report about an unloaded library has no name that a suppression could
// match, so libraries stay loaded until the process ends.
extern "C" int dlclose(void* /*library*/) { return 0; }
