// Colours of part programs: what a word is, by its letter.
import { StreamLanguage } from "../../vendor/codemirror.js";

const STATEMENT =
  /^(IF|THEN|GOTO|GOSUB|RET|PRINT|INPUT|AND|OR|XOR|NOT|MOD|WHILE|ENDWHILE|CALL|SUB|ENDSUB|RETURN|REM)\b/i;
const FUNCTION = /^(SIN|COS|TAN|ATAN|ASIN|ACOS|SQRT|ABS|INT|ROUND|FIX|FUP|LN|EXP|INP|OUT|BIT)\b/i;
const NUMBER = /^[-+\u2212\u2013]*(\d+(\.\d*)?|\.\d+)/;
const EXPRESSION =
  /[A-Z=+*/,(<>-]\s*$|\b(IF|GOTO|GOSUB|SIN|COS|TAN|ATAN|ASIN|ACOS|SQRT|ABS|INT|ROUND|FIX|FUP|LN|EXP|INP|OUT|BIT)\s*$/i;

/** Language of the editor; one token per word. */
export const gcode = StreamLanguage.define({
  name: "gcode",
  token(stream) {
    if (stream.eatSpace()) return null;
    if (stream.sol() && stream.match(/^\s*(%|REM\b).*/i)) return "comment";
    if (stream.match(/^;.*/)) return "comment";
    if (stream.peek() === "(" && !EXPRESSION.test(stream.string.slice(0, stream.pos))) {
      stream.match(/^\([^)]*\)?/);
      return "comment";
    }
    if (stream.match(/^"[^"]*"?/)) return "string";
    if (stream.match(STATEMENT)) return "controlKeyword";
    if (stream.match(FUNCTION)) return "standardFunction";
    if (stream.match(/^N\s*\d+/i)) return "labelName";
    if (stream.match(/^G\s*\d+(\.\d)?/i)) return "keyword";
    if (stream.match(/^[MT]\s*\d+/i)) return "typeName";
    if (stream.match(/^[FS]\s*(?=[-+.\d(#P])/i)) return "attributeName";
    if (stream.match(/^[#P]+\d*/i)) return "variableName";
    if (stream.match(NUMBER)) return "number";
    if (stream.match(/^[A-Z]/i)) return "propertyName";
    stream.next();
    return "operator";
  },
});
