# Writes OUT, a header with the version and the commit of the sources in SOURCE, if it would change. Only commits count
# that can change the program: a change of the docs links nothing anew. Without git, or outside a clone, the version alone.
set(parts src include idl cmake CMakeLists.txt)
set(commit "")
find_program(git git)
if(git)
  execute_process(COMMAND ${git} -c safe.directory=* log -1 --format=%h --abbrev=10 -- ${parts} WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  execute_process(COMMAND ${git} -c safe.directory=* status --porcelain -- ${parts} WORKING_DIRECTORY ${SOURCE}
                  OUTPUT_VARIABLE changes ERROR_QUIET)
  if(commit AND changes)
    string(APPEND commit "+changes")
  endif()
endif()
if(commit)
  set(text "${VERSION} ${commit}")
else()
  set(text "${VERSION}")
endif()
set(header "#pragma once

namespace fleetmap::apps {

/// Version of the program, and the commit that it was built from; \"+changes\": of sources beyond it.
inline constexpr const char* kVersion = \"${text}\";

}  // namespace fleetmap::apps
")
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT old STREQUAL header)
  file(WRITE ${OUT} "${header}")
endif()
