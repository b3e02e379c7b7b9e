# Builds and installs the library alone, then a consumer that has only the
# installed prefix, and runs it. Any failing step fails the test.
file(REMOVE_RECURSE ${WORK})

function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()

step(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/remap -G ${GENERATOR}
     -D CMAKE_CXX_COMPILER=${CXX} -D REMAP_TESTS=OFF
     -D CMAKE_INSTALL_PREFIX=${WORK}/prefix)
step(${CMAKE_COMMAND} --build ${WORK}/remap)
step(${CMAKE_COMMAND} --install ${WORK}/remap)
step(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${WORK}/build
     -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
     -D CMAKE_PREFIX_PATH=${WORK}/prefix)
step(${CMAKE_COMMAND} --build ${WORK}/build)
step(${WORK}/build/consumer)
