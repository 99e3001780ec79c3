# cmake -D PROGRAM= -D NAME= -D LABEL= -D TIMEOUT= -D REAL_TIME= -D LIST= -P ListSuites.cmake writes into the file
# LIST a test of ctest for each suite of a program of GoogleTest.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: ${failed}")
endif()
string(REGEX MATCHALL "\n[A-Za-z0-9_/]+[.]" suites "\n${listed}")
if(NOT suites)
  message(FATAL_ERROR "${PROGRAM} lists no suite")
endif()
set(tests "")
foreach(suite ${suites})
  string(REGEX REPLACE "[\n.]" "" suite "${suite}")
  string(APPEND tests "add_test([=[${NAME}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
                      "set_tests_properties([=[${NAME}.${suite}]=] PROPERTIES LABELS ${LABEL} TIMEOUT ${TIMEOUT} "
                      "RUN_SERIAL ${REAL_TIME})\n")
endforeach()
file(WRITE ${LIST} "${tests}")
