//! Problems with a text: its file, its YAML, the overrides of the command line.

use super::shorten;
use crate::tree::Found;

problems! {
    /// Problems with a scene's file.
    File {
        Folder = UNREADABLE "this is a folder" help "name a scene file";
        Irregular = UNREADABLE "this is not a regular file" help "name a scene file";
        Missing = UNREADABLE "there is no such file"
            help "check the path, or start a scene with `qrt new NAME`";
        Outside = OUTSIDE "the file is outside the crate's folder"
            help "`qrt!` reads files of the crate alone";
        Denied = UNREADABLE "you may not read this file";
        Failed { why: String } = UNREADABLE "the file cannot be read: {why}";
        TooLarge { most: u64 } = TOO_LARGE { format!("the file is larger than {} MiB", most >> 20) }
            help "put large geometry into mesh files (OBJ, PLY, glTF)";
        NotUtf8 { byte: usize, line: usize } = NOT_UTF8
            "the file is not UTF-8 text: byte {byte}, on line {line}" help "save it as UTF-8";
    }

    /// Problems with a text as YAML.
    Yaml {
        Syntax { why: String } = SYNTAX "not YAML: {why}";
        TabIndents { why: String } = SYNTAX "not YAML: {why}"
            help "indent with spaces: YAML has no tabs in its indentation";
        TabSeparates { why: String } = SYNTAX "not YAML: {why}"
            help "write a space in place of the tab";
        Invisible { why: String } = SYNTAX "not YAML: {why}" help "remove the invisible character";
        Empty = EMPTY "the scene is empty" help "`qrt new NAME` writes a scene to start from";
        DuplicateKey { key: String } = DUPLICATE_KEY
            { format!("the key `{}` is written twice", shorten(key)) }
            label "again here" help "keep one of the two" also "first written here";
        SecondDocument = SECOND_DOCUMENT "a second YAML document starts here"
            help "a file holds one scene";
        Tag { tag: String } = TAG { format!("the YAML tag `{}` has no meaning here", shorten(tag)) }
            help "remove it: a value's type follows from its place in the scene";
        MergeKey = MERGE_KEY "merge keys are not part of YAML 1.2"
            help "write the entries out; whole values can be shared by `*alias`";
        ComplexKey = COMPLEX_KEY "a key must be a word or a text"
            help "a list, a map, an alias or nothing cannot be a key";
        UnknownAlias = ALIAS "this alias has no anchor before it"
            help "write `&name` before the value it stands for";
        RecursiveAlias = ALIAS "this alias stands within its own anchor"
            help "a value cannot contain itself";
        AliasBudget { most: usize } = ALIAS_BUDGET
            "aliases expand to more than {most} values by here"
            help "put large geometry into mesh files (OBJ, PLY, glTF)";
        AliasBytes { most: usize } = ALIAS_BUDGET
            { format!("aliases expand to more than {} MiB of text by here", most >> 20) }
            help "use shorter names and expressions, or fewer aliases";
        TooMany { most: usize } = TOO_LARGE "the scene holds more than {most} values by here"
            help "put large geometry into mesh files (OBJ, PLY, glTF)";
        TooDeep { most: usize } = TOO_DEEP "more than {most} levels of nesting"
            help "a scene needs fewer than ten";
    }

    /// Problems with an override of the command line.
    Override {
        NotAPair = SET_SYNTAX "an override is written key=value"
            help "write it as `--set sampling.path_bits=14`";
        NotAnIndex = SET_SYNTAX "an index is a whole number from 0"
            help "write it as `--set sampling.path_bits=14`";
        NoKey = SET_SYNTAX "a key is missing here" help "write it as `--set sampling.path_bits=14`";
        NoFirstKey = SET_SYNTAX "an override begins with a key"
            help "write it as `--set sampling.path_bits=14`";
        OpenQuote = SET_SYNTAX "this quotation mark is not closed"
            help "write it as `--set 'materials.\"a.b\".mirror.reflectance=[1, 1, 1]'`";
        NoValue = SET_SYNTAX "the value is missing here"
            help "write it as `--set sampling.path_bits=14`";
        Nothing = SET_SYNTAX "an override cannot take a key away"
            help "write a value, or remove the key from the scene's file";
        NoElement { index: usize, count: usize } = SET_PLACE
            "there is no element {index}: the list has {count}";
        NotAList { index: usize, found: Found } = SET_PLACE
            "there is no element {index} in {found}";
        NotAMap { key: String, found: Found } = SET_PLACE "there is no key `{key}` in {found}";
    }
}
