# find_package(merlin) finds this: the library is merlin::merlin.
include(${CMAKE_CURRENT_LIST_DIR}/merlin-targets.cmake)
