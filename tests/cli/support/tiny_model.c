/* SPDX-License-Identifier: MIT */
/* tiny_model FILE [several|sang|nfps|NAME]: weights of a tiny network of both decoders, or of several photographs, as
 * random as training begins with; or a rival's, which is not tiny; or of near lights; or of both decoders under another
 * name. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "model/model_export.h"

int main(int argc, char **argv)
{
    const bool several = argc == 3 && strcmp(argv[2], "several") == 0;
    if (argc != 2 && argc != 3) return 2;
    model_config config = {.name = "tiny",
                           .input_global = true,
                           .material_decoders = 1,
                           .feature_sharing = !several,
                           .gated_attention = true,
                           .relight = several ? MODEL_RELIGHT_BRDF : MODEL_RELIGHT_NETWORK,
                           .lighting = several ? MODEL_LIGHT_ANY : MODEL_LIGHT_POINT,
                           .several = several,
                           .global_illumination = true,
                           .widths = {8, 8, 8, 8, 8},
                           .gi_widths = {8, 8, 8, 8, 8}};
    static const char sang[] = "{\"name\": \"sang\", \"rival\": \"sang\", \"cascades\": 1}";
    if (argc == 3) snprintf(config.name, sizeof config.name, "%s", argv[2]);
    if (argc == 3 && strcmp(argv[2], "nfps") == 0) config = (model_config){.name = "nfps", .nfps_width = 8};
    if (argc == 3 && strcmp(argv[2], "sang") == 0 && model_config_parse(sang, strlen(sang), "sang", &config) != OK)
        return 1;
    nn_graph *g = NULL;
    nn_params *params = NULL;
    char *json = model_config_write(&config);
    status s = json ? model_build(&config, MODEL_WHOLE, &g) : fail(MERLIN_NO_MEMORY, "no memory");
    if (s == OK) s = nn_params_new(g, 1, &params);
    const char *const metadata[][2] = {{"config", json}, {"training", "{}"}, {"presentations", "4"}, {"note", "tiny"}};
    if (s == OK) s = model_export(argv[1], params, metadata, sizeof metadata / sizeof *metadata);
    if (s != OK) fprintf(stderr, "%s\n", status_message());
    nn_params_free(params);
    nn_graph_free(g);
    free(json);
    return s != OK;
}
