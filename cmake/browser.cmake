# The engine of the page of web/browser: libmerlin's estimate in WebAssembly, by clang and Debian's wasi-libc, whose
# headers stand before the system's. cmake --build --preset release --target browser_engine makes merlin.wasm;
# tools/make-web asks for it, and says what is missing.
find_program(MERLIN_WASM_CLANG NAMES clang clang-19 clang-18 clang-14)
set(engine ${PROJECT_SOURCE_DIR}/web/browser/engine)
set(engine_build ${CMAKE_CURRENT_BINARY_DIR}/browser)

file(GLOB engine_sources CONFIGURE_DEPENDS ${engine}/*.c src/base/json/*.c src/image/*.c src/mesh/*.c src/mesh/surface/*.c
  src/estimate/*/*.c src/view/*.c)
list(FILTER engine_sources EXCLUDE REGEX "/(network_features|primaries|vips_library|vips_start)\\.c$")
foreach(source base/status base/parallel base/warnings base/text/report model/model_codes image/write/png image/write/write
               image/metadata/byte_source image/metadata/exif image/metadata/exif_find image/metadata/box_file
               image/metadata/tiff_head)
  list(APPEND engine_sources ${PROJECT_SOURCE_DIR}/src/${source}.c)
endforeach()
list(APPEND engine_sources ${CMAKE_CURRENT_BINARY_DIR}/view_page.c)

# 128-bit registers are in every browser since 2023. Functions that nobody calls are left out, and with them what they
# would need.
set(engine_flags --target=wasm32-wasi -std=c17 -O3 -msimd128 -ffunction-sections -fdata-sections -D_GNU_SOURCE
  -DMERLIN_VERSION="${PROJECT_VERSION}" -Wall -Wno-unknown-pragmas -Wno-source-uses-openmp
  -I${engine}/include -I${engine} -I${PROJECT_SOURCE_DIR}/src -I${PROJECT_SOURCE_DIR}/include)
if(MERLIN_WASM_CLANG)
  foreach(source ${engine_sources})
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${source})
    string(REPLACE "/" "_" name ${name})
    set(object ${engine_build}/${name}.o)
    list(APPEND engine_objects ${object})
    add_custom_command(OUTPUT ${object} DEPENDS ${source} DEPFILE ${object}.d
      COMMAND ${CMAKE_COMMAND} -E make_directory ${engine_build}
      COMMAND ${MERLIN_WASM_CLANG} ${engine_flags} -MD -MF ${object}.d -c ${source} -o ${object} VERBATIM)
  endforeach()
  # The functions of page_calls.h are called from outside, those of imports.txt are the page's.
  add_custom_command(OUTPUT ${engine_build}/merlin.wasm
    DEPENDS ${engine_objects} ${engine}/imports.txt ${engine}/exports.txt
    COMMAND ${MERLIN_WASM_CLANG} --target=wasm32-wasi -mexec-model=reactor -Wl,--gc-sections -Wl,--strip-all
    -Wl,-z,stack-size=1048576 -Wl,--allow-undefined-file=${engine}/imports.txt -Wl,@${engine}/exports.txt ${engine_objects}
    -o ${engine_build}/merlin.wasm VERBATIM)
  add_custom_target(browser_engine DEPENDS ${engine_build}/merlin.wasm)
endif()
