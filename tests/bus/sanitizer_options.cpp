// Suppresses the sanitizers' reports on Fast DDS 2.9.1 itself, which is not ours to repair. Without
// sanitizers these functions are not called.

extern "C" {

/// Fast DDS's statistics module deletes an object through a base without a virtual destructor.
const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }

/// Keeps as much of what threads did as can be, so that reports have both stacks and suppressions match.
const char* __tsan_default_options();  // NOLINT(bugprone-reserved-identifier)
const char* __tsan_default_options() { return "history_size=7"; }

/// Fast DDS locks its timed mutexes with pthread_mutex_clocklock, which GCC 12's thread sanitizer does not
/// see: it reports their unlocking, and orders of locks that it only half knows. It maps one file of shared
/// memory at several addresses, so that one lock looks like several: mapping it and copying samples into it
/// are left out, which only Fast DDS does here. All other data races count.
const char* __tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
const char* __tsan_default_suppressions() {
  return "mutex:libfastrtps\ndeadlock:libfastrtps\n"
         "race_top:mmap\nrace:SharedMemTransport::copy_to_shared_buffer\n";
}
}
