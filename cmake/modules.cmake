# One static library a folder of src/, and one program a folder of commands.

# merlin_module(FOLDER [PARTS folders...] LINK targets...): src/FOLDER/**.c becomes merlin_NAME, NAME the folder's own
# name; a folder of headers alone becomes an interface library. PARTS is for tools/check-includes: all sub-folders, in
# the order in which they stand on one another.
function(merlin_module folder)
  cmake_parse_arguments(ARG "" "" "PARTS;LINK" ${ARGN})
  get_filename_component(name ${folder} NAME)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${folder}/*.c)
  if(sources)
    add_library(merlin_${name} STATIC ${sources})
    target_include_directories(merlin_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
    target_link_libraries(merlin_${name} PUBLIC ${ARG_LINK})
  else()
    add_library(merlin_${name} INTERFACE)
    target_include_directories(merlin_${name} INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
    target_link_libraries(merlin_${name} INTERFACE ${ARG_LINK})
  endif()
endfunction()

# merlin_loads(NAME MACRO library headers...): merlin_NAME loads the library when it needs it (base/library.h), by the
# name in MERLIN_MACRO, under which programs that were linked with it would know it.
function(merlin_loads name macro library)
  find_library(${macro}_FILE ${library} REQUIRED)
  file(REAL_PATH ${${macro}_FILE} file)
  string(REGEX MATCH "lib[^/]*\\.so\\.[0-9]+" soname ${file})
  if(NOT soname)
    message(FATAL_ERROR "${file} is no shared library with a version in its name")
  endif()
  target_compile_definitions(merlin_${name} PRIVATE MERLIN_${macro}="${soname}")
  target_include_directories(merlin_${name} SYSTEM PRIVATE ${ARGN})
endfunction()

# merlin_program(NAME FOLDER [PARTS folders...] LINK targets... [WITH targets...]): src/FOLDER/**.c becomes the program
# NAME. WITH has what is linked, too, for the functions of include/merlin: tools/check-includes keeps its headers out.
function(merlin_program name folder)
  cmake_parse_arguments(ARG "" "" "PARTS;LINK;WITH" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${folder}/*.c)
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} ${ARG_WITH})
endfunction()
