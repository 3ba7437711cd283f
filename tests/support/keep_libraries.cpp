// Part of the programs of sanitizer builds only. Graphics drivers leave a few bytes behind
// when they are unloaded; a report about an unloaded library has no name that a suppression could
// match, and the thread sanitizer ends a program that unloads a library of which it shall say
// nothing. So libraries stay loaded until the process ends.
extern "C" int dlclose(void* /*library*/) { return 0; }
