// SPDX-License-Identifier: MIT
// cJSON's functions for the engine: trees are JavaScript's own values; an item in the engine's memory is as large as a
// cJSON, all zeros, and stands for one of them.

const ITEM = 40; // bytes, sizeof(cJSON)

export function json_tree(engine) {
    const values = new Map(); // by address
    const add = (value) => {
        const at = engine.allocate(ITEM);
        if (at) values.set(at, value);
        return at;
    };
    const value_of = (at) => values.get(at);
    const print = (at, space) => engine.put_text(JSON.stringify(value_of(at), null, space));
    // Items inside are values of their parent once they are added: freed with it in cJSON, here at once.
    function put(to, item, place) {
        if (!to || !item) return 0;
        place(value_of(to), value_of(item));
        (value_of(to)[items] ??= []).push(item);
        return 1;
    }
    const items = Symbol("items");
    function free(at) {
        if (!at) return;
        for (const item of value_of(at)?.[items] || []) free(item);
        values.delete(at);
        engine.free(at);
    }
    return {
        cJSON_CreateObject: () => add({}),
        cJSON_CreateArray: () => add([]),
        cJSON_CreateNumber: (number) => add(number),
        cJSON_CreateBool: (is) => add(Boolean(is)),
        cJSON_CreateString: (text) => add(engine.text_at(text)),
        cJSON_CreateNull: () => add(null),
        cJSON_AddItemToObject: (to, key, item) => put(to, item, (object, value) => { object[engine.text_at(key)] = value; }),
        cJSON_AddItemToArray: (to, item) => put(to, item, (array, value) => array.push(value)),
        cJSON_Delete: free,
        cJSON_Print: (at) => print(at, "\t"),
        cJSON_PrintUnformatted: (at) => print(at),
    };
}
